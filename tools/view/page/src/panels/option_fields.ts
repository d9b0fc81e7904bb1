// SPDX-License-Identifier: MIT
//
// Which fields the options panel has. The door lists the options; the members of its objects are here, as
// docs/requests.md has them.

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

interface Member {
  name: string;
  control: Control;
  help: string;
  range?: string;
  unset: string;
  choices?: readonly string[];
  isUsed?: (policy: unknown) => boolean;
}

const kAboveZero = 'above 0';

const kMembers: Readonly<Record<string, readonly Member[]>> = {
  limits: [
    { name: 'speed_m_per_s', control: 'number', help: 'of the eye', range: kAboveZero, unset: 'no limit' },
    { name: 'acceleration_m_per_s2', control: 'number', help: 'of the eye', range: kAboveZero, unset: 'no limit' },
    { name: 'turn_rate_deg_per_s', control: 'number', help: 'of the camera', range: kAboveZero, unset: 'no limit' },
    { name: 'retime', control: 'boolean', help: 'the path may be slowed to meet the limits', unset: 'false' },
  ],
  orientation: [
    {
      name: 'policy',
      control: 'choice',
      help: 'free: turn the camera as needed; keep: do not turn it; level: do not tilt the horizon; target: look at a point',
      unset: 'free',
      choices: ['free', 'keep', 'level', 'target'],
    },
    { name: 'up', control: 'vector', help: 'upward direction', unset: '0, 1, 0', isUsed: (policy) => policy === 'level' },
    { name: 'target', control: 'vector', help: 'point to look at, m', unset: '', isUsed: (policy) => policy === 'target' },
    {
      name: 'cone_deg',
      control: 'number',
      help: 'the direction of view stays within this angle of the target',
      range: 'above 0 and at most 180',
      unset: '28.6',
      isUsed: (policy) => policy === 'target',
    },
    { name: 'max_turn_deg', control: 'number', help: 'never turn the camera further', range: 'between 0 and 180', unset: 'no limit' },
  ],
  bounds: [
    { name: 'min', control: 'vector', help: 'lower corner, m; an empty coordinate is no limit', unset: '' },
    { name: 'max', control: 'vector', help: 'upper corner, m; an empty coordinate is no limit', unset: '' },
  ],
};

const kControls: Readonly<Record<Field['type'], Control>> = {
  number: 'number',
  count: 'whole',
  boolean: 'boolean',
  choice: 'choice',
  object: 'json',
};

/** The groups of the panel, in the order of the door. */
export function fieldGroups(fields: readonly Field[]): FieldGroup[] {
  return fields.map((field) => ({ name: field.name, help: plain(field.help), fields: fieldsOf(field) }));
}

function fieldsOf(field: Field): OptionField[] {
  const members = field.type === 'object' ? kMembers[field.name] : undefined;
  if (!members) {
    return [
      {
        path: [field.name],
        control: kControls[field.type] ?? 'json',
        help: '',
        unit: field.unit ?? unitOf(field.name),
        range: rangeOf(field.range),
        rule: field.range ?? '',
        unset: unsetOf(field.default),
        choices: field.choices ?? [],
        isUsed: () => true,
      },
    ];
  }
  return members.map((member) => ({
    path: [field.name, member.name],
    control: member.control,
    help: member.help,
    unit: unitOf(member.name),
    range: rangeOf(member.range),
    rule: member.range ?? '',
    unset: member.unset,
    choices: member.choices ?? [],
    isUsed: (request) => member.isUsed?.(optionAt(request, ['orientation', 'policy'])) ?? true,
  }));
}

function unsetOf(unset: unknown): string {
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

/** Help without the marks of Markdown. */
function plain(text: string): string {
  return text.replaceAll('`', '');
}

/** Whether the request sets something in the group. */
export function isSet(request: PlanRequest | undefined, path: readonly string[]): boolean {
  return optionAt(request, path) !== undefined;
}
