// SPDX-License-Identifier: MIT
//
// Colours and names that the page shares with `camway draw` (tools/drawing/palette.h); a test compares the two.
// The colours are those of Okabe and Ito, which people with any kind of colour vision tell apart. No view tells
// things apart by colour alone.

export const kPalette = {
  before: '#E69F00',
  collision: '#D55E00',
  after: '#0072B2',
  corrected: '#56B4E9',
  inserted: '#009E73',
  infeasible: '#CC79A7',
  clearanceLow: '#D55E00',
  clearanceMiddle: '#F0E442',
  clearanceHigh: '#0072B2',
} as const;

/** Given keyframes are drawn in the colour of text, so that they differ from the ground in either theme. */
export const kGivenKeyframe = { light: '#000000', dark: '#FFFFFF' } as const;

export const kNames = {
  before: 'path as interpolated',
  collision: 'collision',
  after: 'path',
  corrected: 'corrected',
  inserted: 'inserted keyframe',
  given: 'given keyframe',
  infeasible: 'surface that cannot be passed',
} as const;

type Rgb = readonly [number, number, number];

function rgbOf(hex: string): Rgb {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

const kLow = rgbOf(kPalette.clearanceLow);
const kMiddle = rgbOf(kPalette.clearanceMiddle);
const kHigh = rgbOf(kPalette.clearanceHigh);

/** A clearance of that many metres and more is drawn as comfortable. */
export const kComfortableClearance_m = 0.3;

/**
 * Colour of a clearance as sRGB components from 0 to 1: vermillion at 0, yellow half way, blue from `comfortable_m`
 * on. Clearances that are no number are drawn like 0.
 */
export function clearanceColour(clearance_m: number, comfortable_m: number = kComfortableClearance_m): Rgb {
  const share = Math.min(1, Math.max(0, clearance_m / comfortable_m)) || 0;
  const [from, to, part] = share < 0.5 ? [kLow, kMiddle, 2 * share] : [kMiddle, kHigh, 2 * share - 1];
  return [mix(from[0], to[0], part), mix(from[1], to[1], part), mix(from[2], to[2], part)];
}

function mix(from: number, to: number, part: number): number {
  return from + (to - from) * part;
}
