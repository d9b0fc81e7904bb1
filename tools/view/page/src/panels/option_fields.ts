// SPDX-License-Identifier: MIT
//
// The fields of the options panel are those that the door lists.

import type { Field } from '../contract/door.js';
import type { PlanRequest } from '../contract/request.js';
import { optionAt } from '../model/edits.js';
import type { Range } from './ranges.js';
import { rangeOf } from './ranges.js';

export type Control = 'number' | 'whole' | 'boolean' | 'choice' | 'vector' | 'json';

/** A field of the panel: an option, or a member of one. */
export interface OptionField {
  /** Where it is in `options`. */
  path: readonly string[];
  control: Control;
  help: string;
  unit: string;
  range: Range | undefined;
  /** Words about the range. */
  rule: string;
  /** What holds where the option is not set. */
  unset: string;
  choices: readonly string[];
  /** Shown only where this holds of the request. */
  isUsed: (request: PlanRequest | undefined) => boolean;
}

/** A group of fields under the name of an option that is an object; a plain option is a group of one. */
export interface FieldGroup {
  name: string;
  help: string;
  fields: readonly OptionField[];
}

/** What the field table has no words for: help on members of objects, and when they count. */
interface Member {
  help?: string;
  unset?: string;
  isUsed?: (policy: unknown) => boolean;
}

const kMembers: Readonly<Record<string, Readonly<Record<string, Member>>>> = {
  limits: {
    speed_m_per_s: { help: 'of the eye', unset: 'no limit' },
    acceleration_m_per_s2: { help: 'of the eye', unset: 'no limit' },
    turn_rate_deg_per_s: { help: 'of the camera', unset: 'no limit' },
    retime: { help: 'the path may be slowed to meet the limits' },
  },
  orientation: {
    policy: {
      help: 'free: turn the camera as needed; keep: do not turn it; level: do not tilt the horizon; target: look at a point',
    },
    up: { help: 'the upward direction', isUsed: (policy) => policy === 'level' },
    target: { help: 'the point to look at, m', isUsed: (policy) => policy === 'target' },
    cone_deg: { help: 'the direction of view stays this near to the target', isUsed: (policy) => policy === 'target' },
    max_turn_deg: { unset: 'no limit' },
  },
  bounds: {
    min: { help: 'lower corner, m; without a coordinate there is no limit' },
    max: { help: 'upper corner, m; without a coordinate there is no limit' },
  },
};

const kControls: Readonly<Record<Field['type'], Control>> = {
  number: 'number',
  count: 'whole',
  boolean: 'boolean',
  choice: 'choice',
  vector: 'vector',
  object: 'json',
};

/** Of a default, as angles in degrees have sixteen. */
const kShownDigits = 6;

/** The groups of the panel, in the order of the door. */
export function fieldGroups(fields: readonly Field[]): FieldGroup[] {
  return fields.map((field) => ({ name: field.name, help: plain(field.help), fields: fieldsOf(field) }));
}

function fieldsOf(field: Field): OptionField[] {
  if (!field.fields?.length) return [{ ...controlOf(field), path: [field.name], help: '', isUsed: () => true }];
  return field.fields.map((member) => {
    const words = kMembers[field.name]?.[member.name];
    return {
      ...controlOf(member, words?.unset),
      path: [field.name, member.name],
      help: plain(member.help) || words?.help || '',
      isUsed: (request) => words?.isUsed?.(optionAt(request, ['orientation', 'policy'])) ?? true,
    };
  });
}

function controlOf(field: Field, unset = ''): Omit<OptionField, 'path' | 'help' | 'isUsed'> {
  return {
    control: kControls[field.type] ?? 'json',
    unit: field.unit ?? unitOf(field.name),
    range: rangeOf(field.range),
    rule: field.range ?? '',
    unset: unsetOf(field.default ?? field.unset) || unset,
    choices: field.choices ?? [],
  };
}

function unsetOf(unset: unknown): string {
  if (typeof unset === 'number') return String(Number(unset.toPrecision(kShownDigits)));
  if (Array.isArray(unset)) return unset.join(', ');
  return typeof unset === 'object' && unset !== null ? JSON.stringify(unset) : plain(String(unset ?? ''));
}

const kUnits: readonly (readonly [suffix: string, unit: string])[] = [
  ['_m_per_s2', 'm/s²'],
  ['_m_per_s', 'm/s'],
  ['_deg_per_s', '°/s'],
  ['_deg', '°'],
  ['_m', 'm'],
  ['_s', 's'],
];

/** The unit that a name ends with. */
export function unitOf(name: string): string {
  return kUnits.find(([suffix]) => name.endsWith(suffix))?.[1] ?? '';
}

/** The name of an option as people read it: "Clearance, m" for `clearance_m`. */
export function labelOf(name: string, unit = unitOf(name)): string {
  const suffix = kUnits.find(([end]) => name.endsWith(end))?.[0] ?? '';
  const words = name.slice(0, name.length - suffix.length).replaceAll('_', ' ');
  return `${words.charAt(0).toUpperCase()}${words.slice(1)}${unit ? `, ${unit}` : ''}`;
}

/** Help without the marks of Markdown. */
function plain(text: string): string {
  return text.replaceAll('`', '');
}

/** Whether the request sets something in the group. */
export function isSet(request: PlanRequest | undefined, path: readonly string[]): boolean {
  return optionAt(request, path) !== undefined;
}
