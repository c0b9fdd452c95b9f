/**
 * Light that wet walls send back reaches tissue from all round, but not from where a shaft stands before it: that
 * darkens the tissue under and beside a tip, most where they touch, and shows how near it is. A shaft is taken as a
 * rod with round ends; a rod of radius r at a distance d from a point, seen at an angle whose cosine to the point's
 * normal is c, takes about (r/d)^2 (1 + c)/2 of it.
 */

import { Vector3 } from "three";

import { add, scale, type Vector } from "../vector";

const REACH = 0.03; // of a shaft, from its tip, that comes near enough to matter [m]

export class ContactShade {
  readonly uniforms = {
    shaftFrom: { value: [new Vector3(), new Vector3()] },
    shaftTo: { value: [new Vector3(), new Vector3()] },
    shaftRadius: { value: [0, 0] },
  };

  /**
   * Let an instrument take light away.
   *
   * @param tip its working end [m]. @param back unit vector from there along the shaft.
   * @param start where along the shaft it is solid [m]. @param radius there [m]; zero takes nothing.
   */
  place(side: 0 | 1, tip: Vector, back: Vector, start: number, radius: number): void {
    this.uniforms.shaftFrom.value[side]?.set(...add(tip, scale(back, start + radius)));
    this.uniforms.shaftTo.value[side]?.set(...add(tip, scale(back, start + REACH)));
    this.uniforms.shaftRadius.value[side] = radius;
  }
}

/** What a fragment shader needs: how much light is left at a point, in the eye's frame. */
export const LEFT_OF_LIGHT = `
uniform vec3 shaftFrom[ 2 ];
uniform vec3 shaftTo[ 2 ];
uniform float shaftRadius[ 2 ];
float leftOfLight( vec3 at, vec3 normal ) {
	float left = 1.0;
	for ( int k = 0; k < 2; k ++ ) {
		if ( shaftRadius[ k ] == 0.0 ) continue;
		vec3 from = ( viewMatrix * vec4( shaftFrom[ k ], 1.0 ) ).xyz;
		vec3 along = ( viewMatrix * vec4( shaftTo[ k ], 1.0 ) ).xyz - from;
		float share = clamp( dot( at - from, along ) / max( dot( along, along ), 1e-9 ), 0.0, 1.0 );
		vec3 towards = from + share * along - at;
		float away = max( length( towards ), 1e-6 );
		float seen = shaftRadius[ k ] / max( away, shaftRadius[ k ] + 1e-6 );
		left *= 1.0 - 0.8 * seen * seen * ( 0.5 + 0.5 * dot( normal, towards ) / away );
	}
	return left;
}
`;
