// SPDX-License-Identifier: MIT
import type { Keyframe } from '../contract/request.js';
import type { Actions, DocumentFacts } from '../model/actions.js';
import { timeText } from '../model/format.js';
import { beginOf } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { isTimed, timesOnPath } from '../model/times.js';
import { make, makeButton } from './dom.js';
import { numberInput } from './inputs.js';
import { isEditable, renderKeepingFocus, whileVisible } from './render.js';

/** Rows about the selected keyframe; paths of thousands of keyframes are shown in part. */
const kMostRows = 200;

export interface KeyframePanel {
  setDocument(facts: DocumentFacts): void;
}

interface Row {
  time_s: number;
  keyframe: Keyframe;
  /** Index in the request; undefined for an inserted keyframe. */
  index: number | undefined;
}

/** Makes the list of keyframes: given ones are counted from 0, as in messages; inserted ones stand in between. */
export function makeKeyframePanel(host: HTMLElement, store: Store, actions: Actions): KeyframePanel {
  let documentFacts: DocumentFacts | undefined;
  const content = (now: State): Node[] => contentOf(now, actions, documentFacts);
  const invalidate = whileVisible(host, store, isChanged, (now) => renderKeepingFocus(host, content(now)));
  host.addEventListener('keydown', (event) => {
    if (event.key !== 'Delete' || !(event.target instanceof HTMLButtonElement)) return;
    const { selection } = store.now;
    if (selection && 'keyframe' in selection && isEditable(store.now)) actions.deleteKeyframe(selection.keyframe);
  });
  return {
    setDocument(facts) {
      documentFacts = facts;
      invalidate();
    },
  };
}

function isChanged(now: State, before: State): boolean {
  return (
    now.request !== before.request ||
    now.answer !== before.answer ||
    now.selection !== before.selection ||
    now.connection !== before.connection ||
    (now.cursor_s !== before.cursor_s && currentRow(now) !== currentRow(before))
  );
}

function contentOf(state: State, actions: Actions, documentFacts: DocumentFacts | undefined): Node[] {
  const request = state.request;
  const editable = isEditable(state);
  const tools = editable ? [toolsOf(state, actions, documentFacts)] : [];
  if (!request) return [...tools, make('p', { class: 'cw-empty', text: 'No keyframes yet.' })];
  const rows = rowsOf(state);
  const selected = selectedOf(state);
  const [from, to] = windowOf(rows, selected);
  const current = currentRow(state);
  const items = rows.slice(from, to).map((row, i) => itemOf(state, row, row.index !== undefined && row.index === selected, from + i === current, actions));
  const left = rows.length - (to - from);
  const rest = left > 0 ? [make('p', { class: 'cw-muted', text: `${left} more are not listed; select one in the time line.` })] : [];
  const keyframe = selected !== undefined ? request.keyframes[selected] : undefined;
  const details = editable && keyframe && selected !== undefined ? [detailsOf(state, selected, keyframe, actions)] : [];
  return [...tools, make('ol', { class: 'cw-list cw-keyframes', 'aria-label': 'Keyframes' }, ...items), ...rest, ...details];
}

function toolsOf(state: State, actions: Actions, facts: DocumentFacts | undefined): HTMLElement {
  const selected = selectedOf(state);
  const hasPath = pathOf(state).length > 0;
  const tool = (key: string, text: string, title: string, isOn: boolean, run: () => void): HTMLButtonElement => {
    const button = makeButton(text, run, { title, 'aria-label': text.length > 1 ? text : title });
    button.dataset['key'] = key;
    button.disabled = !isOn;
    return button;
  };
  return make(
    'div',
    { class: 'cw-row cw-tools' },
    tool('insert', 'Insert', 'Inserts a keyframe into the path, at the time of the cursor', hasPath, () => actions.insertKeyframe(state.cursor_s)),
    tool('view', 'Add view', 'Adds a keyframe at the end, from the view of the scene', true, () => actions.insertKeyframe()),
    tool('delete', 'Delete', 'Deletes the selected keyframe', selected !== undefined, () => selected !== undefined && actions.deleteKeyframe(selected)),
    tool('undo', '↶', 'Undo', facts?.canUndo ?? false, () => actions.undo()),
    tool('redo', '↷', 'Redo', facts?.canRedo ?? false, () => actions.redo()),
  );
}

/** The keyframes of the request with those that the answer inserted, in the order of time. */
function rowsOf(state: State): Row[] {
  const { request, answer } = state;
  if (!request) return [];
  const times = timesOnPath(request, answer);
  const given = request.keyframes.map((keyframe, index): Row => ({ time_s: times[index] as number, keyframe, index }));
  const inserted = (answer?.segments?.length ? answer.keyframes : [])
    .filter((keyframe) => keyframe.origin === 'inserted' && keyframe.time !== undefined)
    .map((keyframe): Row => ({ time_s: keyframe.time as number, keyframe, index: undefined }));
  return [...given, ...inserted].sort((a, b) => a.time_s - b.time_s);
}

/** Index of the last row at the cursor or before it. */
function currentRow(state: State): number {
  return rowsOf(state).filter((row) => row.time_s <= state.cursor_s).length - 1;
}

function selectedOf(state: State): number | undefined {
  const { selection, request } = state;
  if (!selection || !('keyframe' in selection)) return undefined;
  return request?.keyframes[selection.keyframe] ? selection.keyframe : undefined;
}

function windowOf(rows: readonly Row[], selected: number | undefined): [from: number, to: number] {
  const middle = selected === undefined ? 0 : rows.findIndex((row) => row.index === selected);
  const from = Math.max(0, Math.min(middle - kMostRows / 2, rows.length - kMostRows));
  return [from, Math.min(rows.length, from + kMostRows)];
}

function itemOf(state: State, row: Row, isSelected: boolean, isCurrent: boolean, actions: Actions): HTMLElement {
  const isGiven = row.index !== undefined;
  const button = makeButton('', () => {
    actions.seek(row.time_s);
    if (row.index !== undefined) actions.select({ keyframe: row.index });
  }, { class: 'cw-item cw-keyframe' });
  button.dataset['key'] = isGiven ? `row ${row.index}` : `inserted ${row.time_s}`;
  if (isSelected) button.setAttribute('aria-current', 'true');
  const faults = state.answer?.keyframe_faults ?? [];
  const isFault = isGiven && faults.some((fault) => fault.keyframe === row.index);
  const words = [isFault ? 'collides' : '', row.keyframe.repaired ? 'repaired' : ''].filter((word) => word !== '');
  button.append(
    make('span', { class: isGiven ? 'cw-mark-given' : 'cw-mark-inserted', 'aria-hidden': 'true' }),
    make('span', { class: 'cw-item-index', text: isGiven ? String(row.index) : 'inserted' }),
    make('span', { class: 'cw-item-time', text: `${timeText(row.time_s, beginOf(pathOf(state)))} s` }),
    make('span', { class: 'cw-item-name', text: row.keyframe.position.map((x) => x.toFixed(2)).join('  ') }),
  );
  if (words.length > 0) button.append(make('span', { class: isFault ? 'cw-item-detail cw-bad' : 'cw-item-detail', text: words.join(', ') }));
  return make('li', isCurrent ? { class: 'cw-current' } : {}, button);
}

function detailsOf(state: State, index: number, keyframe: Keyframe, actions: Actions): HTMLElement {
  const fields = ['x', 'y', 'z'].map((axis, k) =>
    numberInput(`${axis}, m`, keyframe.position[k], { key: `position ${k}` }, (value) => {
      if (value === undefined) return;
      const position: Keyframe['position'] = [...keyframe.position];
      position[k] = value;
      actions.setKeyframe(index, { position, orientation: keyframe.orientation }, 'full');
    }),
  );
  const timed = state.request !== undefined && isTimed(state.request);
  const time = numberInput('time, s', keyframe.time, { key: 'time', placeholder: 'by speed' }, (value) => {
    if (value !== undefined) actions.setKeyframeTime(index, value);
  });
  const box = make('input', { type: 'checkbox', 'data-key': 'timed' });
  box.checked = timed;
  box.addEventListener('change', () => actions.setTimed(box.checked));
  return make(
    'section',
    {},
    make('h3', { text: `Keyframe ${index}` }),
    make('div', { class: 'cw-fields' }, ...fields, time),
    make('label', { class: 'cw-check', title: 'Without, times follow from the default speed' }, box, 'all keyframes have times'),
  );
}
