/**
 * The material of wet tissue. Light that enters comes out a little beside and redder, so the shade's edge is soft and
 * red; a film of fluid over it glints on relief of its own, shines broadly where a slope turns to lamp and eye, and
 * mirrors the red surroundings at grazing sight. With the lamp beside the lens shades are faint: it is by that shine,
 * as through a real endoscope, that a dent of a millimetre is seen.
 *
 * It is three.js's Blinn-Phong material with its two lines of direct light replaced: the physically based material
 * costs several times as much, which a machine without a graphics processor cannot pay.
 */

import { Color, MeshPhongMaterial, ShaderChunk, type Side, Vector2 } from "three";

import { type ContactShade, LEFT_OF_LIGHT } from "./contact-shade";
import type { Maps } from "./skin-texture";

export interface Wetness {
  readonly tint: Color;
  readonly film: number; // 0 dry to 1 wet
  readonly relief: number; // scale of the fine relief
  readonly side: Side;
  readonly shade: ContactShade;
}

const DIFFUSE = "vec3 irradiance = dotNL * directLight.color;";
const GLINT = "BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal,";

const BLEED = `
	vec3 bleed = vec3( 0.14, 0.03, 0.02 );
	vec3 irradiance = saturate( ( dot( geometryNormal, directLight.direction ) + bleed ) / ( 1.0 + bleed ) ) * directLight.color;
	float grazing = 1.0 - saturate( dot( filmNormal, geometryViewDir ) );
	float towards = saturate( dot( normalize( mix( smoothNormal, geometryNormal, 0.4 ) ), normalize( directLight.direction + geometryViewDir ) ) );
	reflectedLight.directSpecular += film * directLight.color * vec3( 0.200, 0.118, 0.102 ) * pow( towards, 9.0 );
	reflectedLight.directSpecular += film * directLight.color * vec3( 0.030, 0.014, 0.012 ) * grazing * grazing * grazing;
`;

const FILM_NORMAL = `
	#include <normal_fragment_maps>
	smoothNormal = nonPerturbedNormal;
	filmNormal = normalize( tbn * vec3( 1.9 * mapN.xy, mapN.z ) );
`;

const SHADED = `
	float left = leftOfLight( - vViewPosition, normal );
	reflectedLight.indirectDiffuse *= left;
	reflectedLight.directDiffuse *= mix( 1.0, left, 0.6 ); // most of it was sent back before it came here
	#include <aomap_fragment>
`;

const PARS = ShaderChunk.lights_phong_pars_fragment;

export function wetMaterial(maps: Maps, wetness: Wetness): MeshPhongMaterial {
  const material = new MeshPhongMaterial({
    color: wetness.tint,
    map: maps.colour,
    normalMap: maps.relief,
    normalScale: new Vector2(wetness.relief, wetness.relief),
    specularMap: maps.wet,
    specular: new Color(1, 0.95, 0.92).multiplyScalar(0.09 * wetness.film),
    shininess: 70,
    side: wetness.side,
  });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, wetness.shade.uniforms, { film: { value: wetness.film } });
    const light = swap(swap(PARS, DIFFUSE, BLEED), GLINT, GLINT.replace("geometryNormal", "filmNormal"));
    const pars = `uniform float film;\nvec3 filmNormal;\nvec3 smoothNormal;\n${LEFT_OF_LIGHT}\n${light}`;
    let text = swap(shader.fragmentShader, "#include <lights_phong_pars_fragment>", pars);
    text = swap(text, "#include <normal_fragment_maps>", FILM_NORMAL);
    shader.fragmentShader = swap(text, "#include <aomap_fragment>", SHADED);
  };
  return material;
}

/** Replace a piece of three.js's own shader; that it is not there is our mistake, after an update of three.js. */
function swap(text: string, piece: string, by: string): string {
  if (!text.includes(piece)) throw new Error(`three.js's shader has changed: ${piece} is not in it`);
  return text.replace(piece, by);
}
