// SPDX-License-Identifier: MIT
//
// Answers in words. The meanings are those of docs/answers.md.

import type { Answer, Correction, Infeasibility, KeyframeFault, Status } from '../contract/answer.js';
import { counted, lowerBoundText, numberText, withUnit } from '../model/format.js';
import { correctionWords } from '../timeline/bands.js';

/** Smaller lengths and angles are of rounding, and shown as 0. */
const kRounding = 1e-9;

export interface StatusWords {
  /** Tells statuses apart without colour. */
  symbol: string;
  title: string;
  meaning: string;
}

const kStatuses: Readonly<Record<Status, StatusWords>> = {
  ok: { symbol: '✓', title: 'Proved free', meaning: 'The path is proved free of collision at every instant.' },
  partial: { symbol: '◐', title: 'Partial', meaning: 'The path still has collisions, or breaks a limit.' },
  infeasible: { symbol: '⊘', title: 'No path exists', meaning: 'That is proved, and shown below.' },
  timeout: { symbol: '◔', title: 'Out of time', meaning: 'The deadline came before planning was finished.' },
  invalid: { symbol: '!', title: 'Cannot be planned', meaning: 'The request has to be changed.' },
  internal_error: { symbol: '✕', title: 'Fault of Camway', meaning: 'Please report this, with the request.' },
};

export function statusWords(status: Status): StatusWords {
  return kStatuses[status] ?? { symbol: '?', title: status, meaning: '' };
}

/** What the certificate says, or undefined without one. */
export function certificateWords(answer: Answer): string | undefined {
  if (!answer.certificate?.certified) return undefined;
  const clearance_m = answer.certificate.clearance_lower_bound;
  return `Certified: ${lowerBoundText(clearance_m)} m or more from the scene at every instant.`;
}

export function correctionText(correction: Correction): string {
  if (correction.kind === 'none') {
    const tried = triedWords(correction.tried);
    return tried ? `not corrected; tried ${tried}` : 'not corrected';
  }
  const sizes: string[] = [];
  if (correction.moved_m > kRounding) sizes.push(withUnit(correction.moved_m, 'm'));
  if (correction.turned_deg > kRounding) sizes.push(withUnit(correction.turned_deg, '°'));
  const most = sizes.length > 0 ? `, at most ${sizes.join(' and ')}` : '';
  return `${correctionWords(correction)}${most}; shift up to ${withUnit(correction.largest_shift_deg, '°')}`;
}

const kTried: readonly (readonly [name: string, noun: string])[] = [
  ['directions', 'direction'],
  ['paths', 'changed path'],
  ['lattice_points', 'place on a way round'],
  ['tree_samples', 'random pose'],
];

/** The effort of searches; empty if nothing was tried. */
export function triedWords(tried: Correction['tried']): string {
  const words = kTried.flatMap(([name, noun]) => {
    const count = tried?.[name] ?? 0;
    return count > 0 ? [counted(count, noun, noun === 'place on a way round' ? 'places on a way round' : `${noun}s`)] : [];
  });
  return words.join(', ');
}

interface Cage {
  min: number[];
  max: number[];
  widest_hole_m: number;
  shortest_chord_m: number;
}

/** The proof that there is no path, in sentences. */
export function infeasibilityWords(proof: Infeasibility): string[] {
  const { keyframe_inside: inside, keyframe_outside: outside } = proof;
  const cage = proof.cage as Cage | undefined;
  if (!cage) {
    return [
      `Keyframe ${inside} is inside a closed surface of ${counted(proof.triangles.length, 'triangle')} of the scene, keyframe ${outside} is outside of it.`,
      'A path between the two would pass through the surface. The body cannot, so there is none.',
    ];
  }
  const size = cage.max.map((most, k) => numberText(most - (cage.min[k] ?? 0))).join(' × ');
  const holes =
    cage.widest_hole_m > 0
      ? `The holes in its faces are at most ${withUnit(cage.widest_hole_m, 'm')} wide, and the body is at least ${withUnit(cage.shortest_chord_m, 'm')} wide through its centre.`
      : 'Its faces have no holes.';
  return [
    `Keyframe ${inside} is inside a box of ${size} m, keyframe ${outside} is outside of it.`,
    `${holes} So the body fits through none of them, and there is no path between the two.`,
  ];
}

/** Words for a keyframe that the searches found no way out of. No proof. */
export function shutInWords(keyframe: number): string {
  return `No search found a way out of the place where keyframe ${keyframe} is. That is no proof that there is none.`;
}

export function faultText(fault: KeyframeFault): string {
  const depth = fault.depth_m !== undefined && fault.depth_m > 0 ? `; it has to move by about ${withUnit(fault.depth_m, 'm')}` : '';
  return `Keyframe ${fault.keyframe} collides${depth}.`;
}

export interface MeasureRow {
  label: string;
  unit: string;
  before: number | undefined;
  after: number | undefined;
  /** Rounded down, not to the nearest. */
  isLowerBound: boolean;
}

const kClearance = 'clearance_lower_bound_m';

const kMeasures: readonly (readonly [name: string, label: string, unit: string])[] = [
  ['length_m', 'length', 'm'],
  [kClearance, 'clearance, certified', 'm'],
  ['largest_deviation_m', 'largest deviation', 'm'],
  ['largest_shift_deg', 'largest shift', '°'],
  ['mean_shift_deg', 'mean shift', '°'],
  ['largest_speed_m_per_s', 'largest speed', 'm/s'],
  ['largest_acceleration_m_per_s2', 'largest acceleration', 'm/s²'],
  ['largest_turn_rate_deg_per_s', 'largest turn rate', '°/s'],
  ['largest_turn_acceleration_deg_per_s2', 'turn acceleration', '°/s²'],
  ['bending_energy_m2_per_s3', 'bending energy', 'm²/s³'],
];

export function measureRows(answer: Answer): MeasureRow[] {
  const { before, after } = answer.measures ?? { before: {}, after: {} };
  const rounded = (value: number | undefined): number | undefined => (value !== undefined && Math.abs(value) < kRounding ? 0 : value);
  return kMeasures
    .map(([name, label, unit]) => ({ label, unit, before: rounded(before[name]), after: rounded(after[name]), isLowerBound: name === kClearance }))
    .filter((row) => row.before !== undefined || row.after !== undefined);
}

/** What else was changed: the camera, the times. */
export function otherChanges(answer: Answer): string[] {
  const words: string[] = [];
  if (answer.near_scale !== undefined) {
    words.push(`The camera was shrunk: its near distance is ${numberText(answer.near_scale * 100)} % of that asked for.`);
  }
  if (answer.time_scale !== undefined) {
    words.push(`The path was slowed: it takes ${numberText(answer.time_scale)} times as long.`);
  }
  if (answer['deadline_reached'] === true) words.push('The deadline was reached; planning again may give another answer.');
  return words;
}

export interface StageTime {
  stage: string;
  milliseconds: number;
}

const kStages: Readonly<Record<string, string>> = {
  motion: 'interpolate',
  detect: 'find collisions',
  correct: 'correct',
  certify: 'prove',
};

/** The stages that the total time of planning has, in their order. Reading the scene is none of them. */
export function stageTimes(answer: Answer | undefined): StageTime[] {
  return Object.entries(answer?.timing_ms ?? {})
    .filter(([name, milliseconds]) => name !== 'total' && name !== 'load_scene' && milliseconds > 0)
    .map(([name, milliseconds]) => ({ stage: kStages[name] ?? name.replaceAll('_', ' '), milliseconds }));
}
