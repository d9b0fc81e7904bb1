// SPDX-License-Identifier: MIT
import type { Field } from '../contract/door.js';
import type { Camera } from '../contract/request.js';
import type { Actions, Facts } from '../model/actions.js';
import { optionAt } from '../model/edits.js';
import { withUnit } from '../model/format.js';
import { optionFault } from '../model/option_fault.js';
import type { State, Store } from '../model/store.js';
import { make, makeButton, uniqueId } from './dom.js';
import { numberField, numberInput } from './inputs.js';
import type { FieldGroup, OptionField } from './option_fields.js';
import { fieldGroups, isSet, labelOf } from './option_fields.js';
import { rangeOf } from './ranges.js';
import { isEditable, renderKeepingFocus, whileVisible } from './render.js';

export interface OptionPanel {
  setFacts(facts: Facts): void;
}

const kCamera: readonly (readonly [name: keyof Camera, label: string, range: string])[] = [
  ['fov_x_deg', 'across, °', 'above 0 and below 180'],
  ['fov_y_deg', 'upright, °', 'above 0 and below 180'],
  ['near', 'near, m', 'above 0 and at most 1e9'],
];

/** Makes the panel of the camera and of the options that the door lists. In a review it only tells what is set. */
export function makeOptionPanel(host: HTMLElement, store: Store, actions: Actions): OptionPanel {
  let fields: readonly Field[] = [];
  const render = (now: State): void => renderKeepingFocus(host, contentOf(now, fields, actions));
  const invalidate = whileVisible(host, store, (now, before) => isChanged(now, before), render);
  return {
    setFacts(facts) {
      if (facts.fields === fields) return;
      fields = facts.fields;
      invalidate();
    },
  };
}

function isChanged(now: State, before: State): boolean {
  return (
    now.request?.options !== before.request?.options ||
    now.request?.camera !== before.request?.camera ||
    now.unplanned !== before.unplanned ||
    (now.request === undefined) !== (before.request === undefined) ||
    now.connection !== before.connection
  );
}

function contentOf(state: State, fields: readonly Field[], actions: Actions): Node[] {
  if (!state.request) return [make('p', { class: 'cw-empty', text: 'Open a request to set its options.' })];
  if (!isEditable(state)) return [readOnly(state)];
  const groups = fieldGroups(fields).map((group) => groupOf(state, group, actions));
  const none = fields.length === 0 ? [make('p', { class: 'cw-empty', text: 'The options are not known without a door.' })] : [];
  return [...cameraOf(state, actions), ...groups, ...none];
}

/** What a review's request sets, as text. */
function readOnly(state: State): HTMLElement {
  const { camera, options, body } = state.request ?? {};
  const rows: [string, string][] = [];
  if (camera) {
    rows.push(['camera', `${withUnit(camera.fov_x_deg, '°')} × ${withUnit(camera.fov_y_deg, '°')}, near ${withUnit(camera.near, 'm')}`]);
  }
  if (body) rows.push(['body', String(body['type'] ?? '')]);
  for (const [name, value] of Object.entries(options ?? {})) rows.push([name, typeof value === 'string' ? value : JSON.stringify(value)]);
  const list = make('dl', { class: 'cw-facts' });
  for (const [name, text] of rows) list.append(make('dt', { text: name }), make('dd', { text }));
  return make('section', {}, make('h3', { text: 'Set by the request' }), list, make('p', { class: 'cw-muted', text: 'All other options are as by default.' }));
}

function cameraOf(state: State, actions: Actions): Node[] {
  const camera = state.request?.camera;
  if (!camera) return [];
  const inputs = kCamera.map(([name, label, range]) =>
    numberInput(label, camera[name], { key: `camera ${name}`, range: rangeOf(range)! }, (value) => {
      if (value !== undefined) actions.setCamera({ [name]: value });
    }),
  );
  return [make('section', {}, make('h3', { text: 'Camera' }), make('div', { class: 'cw-fields' }, ...inputs))];
}

function groupOf(state: State, group: FieldGroup, actions: Actions): HTMLElement {
  const isChangedGroup = isSet(state.request, [group.name]);
  const title = make('h3', { class: 'cw-option-name' }, ...namesOf(group.name, group.fields.length === 1 ? group.fields[0]?.unit : ''));
  if (isChangedGroup) {
    const reset = makeButton('reset', () => actions.setOption([group.name], undefined), {
      class: 'cw-reset',
      'aria-label': `Reset ${group.name}`,
      title: 'Back to the default',
    });
    reset.dataset['key'] = `reset ${group.name}`;
    title.append(make('span', { class: 'cw-changed', text: 'changed' }), reset);
  }
  const help = make('p', { class: 'cw-help', id: uniqueId(), text: group.help });
  const fields = group.fields.filter((field) => field.isUsed(state.request)).map((field) => fieldRow(state, field, help.id, actions));
  return make('section', { class: isChangedGroup ? 'cw-option cw-is-changed' : 'cw-option', role: 'group', 'aria-label': group.name }, title, help, ...fields);
}

function fieldRow(state: State, field: OptionField, helpId: string, actions: Actions): HTMLElement {
  const value = optionAt(state.request, field.path);
  const rule = make('span', { class: 'cw-rule', id: uniqueId(), text: field.rule });
  const name = field.path.at(-1) as string;
  const isMember = field.path.length > 1;
  const fault = faultOf(state, field);
  const control = controlOf(field, value, `${helpId} ${rule.id}`, (next) => actions.setOption(field.path, next));
  if (control instanceof HTMLInputElement && control.type === 'checkbox') {
    const label = make('label', { class: 'cw-check' }, control, isMember ? memberOf(name, field) : 'on');
    return make('div', { class: 'cw-option-field' }, label, fault, rule);
  }
  control.setAttribute('aria-label', isMember ? `${field.path[0]}, ${name}` : name);
  const words = isMember ? memberOf(name, field) : undefined;
  if (fault) control.setAttribute('aria-invalid', 'true');
  return make('div', { class: 'cw-option-field' }, words, control, fault, rule);
}

/** The words of the door about a field whose value it refuses. */
function faultOf({ unplanned }: State, { path }: OptionField): HTMLElement | undefined {
  const fault = optionFault(unplanned);
  if (fault?.path.join('.') !== path.join('.')) return undefined;
  return make('span', { class: 'cw-bad cw-wrong', role: 'alert', text: `Refused: it ${fault.words}.` });
}

function memberOf(name: string, { unit, help }: OptionField): HTMLElement {
  return make('span', { class: 'cw-member' }, ...namesOf(name, unit), help ? make('span', { class: 'cw-rule', text: help }) : undefined);
}

/** The label for people, and the name that requests and scripts have. */
function namesOf(name: string, unit: string | undefined): HTMLElement[] {
  return [make('span', { text: labelOf(name, unit) }), make('code', { class: 'cw-code', text: name })];
}

function controlOf(field: OptionField, value: unknown, describedBy: string, changed: (value: unknown) => void): HTMLElement {
  const key = field.path.join(' ');
  switch (field.control) {
    case 'boolean': {
      const box = make('input', { type: 'checkbox', 'data-key': key, 'aria-describedby': describedBy });
      box.checked = value === true;
      box.addEventListener('change', () => changed(box.checked ? true : undefined));
      return box;
    }
    case 'choice':
      return choiceOf(field, value, key, describedBy, changed);
    case 'vector':
      return vectorOf(field, value, key, describedBy, changed);
    case 'json':
      return jsonOf(value, key, describedBy, changed);
    default: {
      const settings = { key, describedBy, isWhole: field.control === 'whole', placeholder: field.unset, ...(field.range ? { range: field.range } : {}) };
      return numberField(typeof value === 'number' ? value : undefined, settings, changed);
    }
  }
}

function choiceOf(field: OptionField, value: unknown, key: string, describedBy: string, changed: (value: unknown) => void): HTMLElement {
  const select = make('select', { 'data-key': key, 'aria-describedby': describedBy });
  select.append(new Option(field.unset ? `default: ${field.unset}` : 'default', ''));
  for (const choice of field.choices) select.append(new Option(choice, choice));
  select.value = typeof value === 'string' ? value : '';
  select.addEventListener('change', () => changed(select.value === '' ? undefined : select.value));
  return select;
}

/** Three numbers. Bounds may leave out coordinates, which are `null` then; other vectors are set when complete. */
function vectorOf(field: OptionField, value: unknown, key: string, describedBy: string, changed: (value: unknown) => void): HTMLElement {
  const list = Array.isArray(value) ? (value as unknown[]) : [];
  const now = [0, 1, 2].map((k) => (typeof list[k] === 'number' ? (list[k] as number) : undefined));
  const unset = field.unset === '' ? [] : field.unset.split(',');
  const mayLack = field.path[0] === 'bounds';
  const inputs = now.map((coordinate, k) => {
    const input = numberField(coordinate, { key: `${key} ${k}`, describedBy, placeholder: unset[k]?.trim() ?? 'xyz'.charAt(k) }, (next) => {
      now[k] = next;
      const isEmpty = now.every((x) => x === undefined);
      const isComplete = now.every((x) => x !== undefined);
      if (isEmpty) changed(undefined);
      else if (isComplete || mayLack) changed(now.map((x) => x ?? null));
    });
    input.setAttribute('aria-label', `${field.path.join(', ')}, ${'xyz'.charAt(k)}`);
    return input;
  });
  return make('span', { class: 'cw-vector', role: 'group' }, ...inputs);
}

/** An object that the page does not know: as JSON. */
function jsonOf(value: unknown, key: string, describedBy: string, changed: (value: unknown) => void): HTMLElement {
  const input = make('input', { type: 'text', value: value === undefined ? '' : JSON.stringify(value), placeholder: 'JSON', 'data-key': key, 'aria-describedby': describedBy });
  input.addEventListener('change', () => {
    try {
      changed(input.value.trim() === '' ? undefined : JSON.parse(input.value));
      input.removeAttribute('aria-invalid');
    } catch {
      input.setAttribute('aria-invalid', 'true');
    }
  });
  return input;
}
