/**
 * The material of wet tissue. Light that enters comes out a little beside and redder, so the shade's edge is soft and
 * red; a film of fluid over it glints on relief of its own, and mirrors the red surroundings at grazing sight.
 *
 * It is three.js's Blinn-Phong material with its two lines of direct light replaced: the physically based material
 * costs several times as much, which a machine without a graphics processor cannot pay.
 */

import { Color, MeshPhongMaterial, ShaderChunk, type Side, Vector2 } from "three";

import type { Maps } from "./skin-texture";

export interface Wetness {
  readonly tint: Color;
  readonly film: number; // 0 dry to 1 wet
  readonly relief: number; // scale of the fine relief
  readonly side: Side;
}

const DIFFUSE = "vec3 irradiance = dotNL * directLight.color;";
const GLINT = "BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal,";

const BLEED = `
	vec3 bleed = vec3( 0.14, 0.03, 0.02 );
	vec3 irradiance = saturate( ( dot( geometryNormal, directLight.direction ) + bleed ) / ( 1.0 + bleed ) ) * directLight.color;
	float grazing = 1.0 - saturate( dot( filmNormal, geometryViewDir ) );
	reflectedLight.directSpecular += film * directLight.color * vec3( 0.030, 0.014, 0.012 ) * grazing * grazing * grazing;
`;

const FILM_NORMAL = `
	#include <normal_fragment_maps>
	filmNormal = normalize( tbn * vec3( 2.6 * mapN.xy, mapN.z ) );
`;

const PARS = ShaderChunk.lights_phong_pars_fragment;

export function wetMaterial(maps: Maps, wetness: Wetness): MeshPhongMaterial {
  const material = new MeshPhongMaterial({
    color: wetness.tint,
    map: maps.colour,
    normalMap: maps.relief,
    normalScale: new Vector2(wetness.relief, wetness.relief),
    specularMap: maps.wet,
    specular: new Color(1, 0.95, 0.92).multiplyScalar(0.075 * wetness.film),
    shininess: 30,
    side: wetness.side,
  });
  material.onBeforeCompile = (shader) => {
    shader.uniforms["film"] = { value: wetness.film };
    const light = swap(swap(PARS, DIFFUSE, BLEED), GLINT, GLINT.replace("geometryNormal", "filmNormal"));
    shader.fragmentShader = swap(
      swap(shader.fragmentShader, "#include <lights_phong_pars_fragment>", `uniform float film;\nvec3 filmNormal;\n${light}`),
      "#include <normal_fragment_maps>",
      FILM_NORMAL,
    );
  };
  return material;
}

/** Replace a piece of three.js's own shader; that it is not there is our mistake, after an update of three.js. */
function swap(text: string, piece: string, by: string): string {
  if (!text.includes(piece)) throw new Error(`three.js's shader has changed: ${piece} is not in it`);
  return text.replace(piece, by);
}
