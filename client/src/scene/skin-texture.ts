/** Colour, wetness and fine relief of wet tissue, as textures that repeat. */

import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  NoColorSpace,
  RepeatWrapping,
  RGBAFormat,
  SRGBColorSpace,
} from "three";

import { makeLobules } from "./lobules";
import { mix, Noise, smoothstep } from "./noise";
import { bySoftware } from "./software";
import { vessels } from "./vessels";

export const TILE = 0.045; // what one period of a texture spans [m]

export type Colour = readonly [number, number, number]; // sRGB, 0 to 255

export interface Look {
  readonly base: Colour;
  readonly patch: Colour; // where blood shines through
  readonly pale: Colour; // strands and fat
  readonly vessel: Colour;
  readonly vesselShare: number; // 0 to 1
  readonly lobules: number; // how much it bulges in lobules, 0 to 1
}

export const WET: Look = {
  base: [214, 128, 112],
  patch: [188, 92, 80],
  pale: [224, 164, 142],
  vessel: [134, 32, 38],
  vesselShare: 0.7,
  lobules: 0,
};

export interface Maps {
  readonly colour: DataTexture;
  readonly relief: DataTexture; // normals, in the tangent frame
  readonly wet: DataTexture; // how thick the film is, in red
}

/**
 * Make the textures of one kind of tissue.
 *
 * @param size of each [texels], a power of two.
 */
export function makeMaps(look: Look, seed: number, size: number): Maps {
  const noise = new Noise(seed);
  const vein = vessels(size, seed + 1);
  const lobule = makeLobules(seed + 2);
  const colour = new Uint8Array(4 * size * size);
  const wet = new Uint8Array(4 * size * size);
  const height = new Float32Array(size * size);
  for (let j = 0; j < size; j++) {
    for (let i = 0; i < size; i++) {
      const at = j * size + i;
      const u = i / size;
      const v = j / size;
      const cloud = noise.sum(u, v, 3, 4);
      const strand = 1 - Math.abs(noise.sum(u + 0.3, v, 4, 3)) * 2.2; // ridges
      const speck = noise.at(u, v, 96);
      const red = smoothstep(-0.5, 0.8, cloud);
      const white = smoothstep(0.3, 1.0, strand) * 0.3;
      const vessel = (vein[at] as number) * look.vesselShare;
      const bulge = look.lobules > 0 ? lobule(u + 0.02 * cloud, v + 0.02 * cloud) : 1;
      const crease = 1 - look.lobules * 0.16 * (1 - smoothstep(0, 0.3, bulge));
      for (let k = 0; k < 3; k++) {
        const blood = mix(look.base[k] as number, look.patch[k] as number, red);
        const strands = mix(blood, look.pale[k] as number, white);
        const seen = mix(strands, look.vessel[k] as number, vessel);
        colour[4 * at + k] = Math.min(Math.max(seen * crease * (1 + 0.07 * speck), 0), 255);
      }
      colour[4 * at + 3] = 255;
      wet[4 * at] = 255 * mix(0.35, 1, smoothstep(-0.3, 0.3, noise.sum(u + 0.71, v + 0.13, 6, 2)));
      const folds = noise.sum(u + 0.5, v + 0.5, 9, 2);
      const grain = noise.sum(u, v, 34, 2);
      height[at] = 0.34 * folds + 0.05 * grain + 0.06 * vessel + 0.12 * look.lobules * smoothstep(0, 0.9, bulge); // [mm]
    }
  }
  return {
    colour: texture(colour, size, SRGBColorSpace),
    relief: texture(normals(height, size), size, NoColorSpace),
    wet: texture(wet, size, NoColorSpace),
  };
}

/** Turn heights [mm] over one tile into normals, coded as colours. */
function normals(height: Float32Array, size: number): Uint8Array {
  const coded = new Uint8Array(4 * size * size);
  const spacing = (2 * TILE * 1000) / size; // between the two texels a slope is taken from [mm]
  const read = (i: number, j: number): number => height[(j & (size - 1)) * size + (i & (size - 1))] as number;
  for (let j = 0; j < size; j++) {
    for (let i = 0; i < size; i++) {
      const x = (read(i - 1, j) - read(i + 1, j)) / spacing;
      const y = (read(i, j - 1) - read(i, j + 1)) / spacing;
      const length = Math.hypot(x, y, 1);
      const at = 4 * (j * size + i);
      coded[at] = 127.5 * (x / length + 1);
      coded[at + 1] = 127.5 * (y / length + 1);
      coded[at + 2] = 127.5 * (1 / length + 1);
      coded[at + 3] = 255;
    }
  }
  return coded;
}

function texture(texels: Uint8Array, size: number, space: string): DataTexture {
  const made = new DataTexture(texels, size, size, RGBAFormat);
  made.wrapS = made.wrapT = RepeatWrapping;
  made.magFilter = LinearFilter;
  made.minFilter = LinearMipmapLinearFilter;
  made.generateMipmaps = true;
  made.anisotropy = bySoftware() ? 1 : 4;
  made.colorSpace = space;
  made.needsUpdate = true;
  return made;
}
