// SPDX-License-Identifier: MIT
// The pace of a walk through a scene: as on foot in rooms, and by the size of what is smaller or larger.

const kSpeed_m_per_s = 1.6;
const kStep_m = 0.35;
/** Radii of the scenes through which people walk as on foot. */
const kRooms_m = { least: 5, most: 40 } as const;

export interface Pace {
  speed_m_per_s: number;
  /** Of one notch of the wheel. */
  step_m: number;
}

/** The pace in a scene of that radius, which is more than 0. */
export function paceOf(radius_m: number): Pace {
  const factor = radius_m < kRooms_m.least ? radius_m / kRooms_m.least : Math.max(1, radius_m / kRooms_m.most);
  return { speed_m_per_s: factor * kSpeed_m_per_s, step_m: factor * kStep_m };
}
