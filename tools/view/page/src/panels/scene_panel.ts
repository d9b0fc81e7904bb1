// SPDX-License-Identifier: MIT
import type { ObjectFacts } from '../contract/door.js';
import type { Actions, Facts, ObjectForm } from '../model/actions.js';
import { counted } from '../model/format.js';
import type { State, Store } from '../model/store.js';
import { make, makeButton } from './dom.js';
import { numberOf } from './inputs.js';
import { renderKeepingFocus, whileVisible } from './render.js';

/** Rows that are listed; the filter finds the others. */
const kMostRows = 150;

const kDefaultSize_m = '0.5';

export interface ScenePanel {
  setFacts(facts: Facts): void;
}

/**
 * Makes the list of the objects of the scene, with a filter; and, unless read only, what adds and removes them. With
 * a daemon the path can be watched.
 */
export function makeScenePanel(host: HTMLElement, store: Store, actions: Actions): ScenePanel {
  const list = make('div', { class: 'cw-objects' });
  const filter = make('input', { type: 'search', placeholder: 'Find an object', 'aria-label': 'Find an object by its name' });
  const adder = adderOf(store, actions);
  const watch = make('input', { type: 'checkbox' });
  watch.addEventListener('change', () => actions.watchPath(watch.checked));
  const watching = make('label', { class: 'cw-check cw-watch' }, watch, 'Watch this path: say when a change of the scene breaks it');
  let hasDaemon = false;
  // At once, also while the panel is hidden: what may not be used is not shown for the time of a frame.
  const updateUse = (now: State): void => {
    adder.hidden = !mayChange(now);
    watching.hidden = !hasDaemon || now.connection !== 'open';
    watch.checked = now.watched !== 'off';
    watch.disabled = (now.answer?.segments?.length ?? 0) === 0;
  };
  store.listen(updateUse);
  updateUse(store.now);
  host.append(watching, filter, list, adder);
  const render = (now: State): void => {
    renderKeepingFocus(list, rowsOf(now, filter.value, actions));
  };
  const invalidate = whileVisible(host, store, isChanged, render);
  filter.addEventListener('input', invalidate);
  return {
    setFacts(facts) {
      hasDaemon = facts.status?.['planner'] === 'daemon';
      updateUse(store.now);
    },
  };
}

function isChanged(now: State, before: State): boolean {
  return (
    now.scene !== before.scene ||
    now.selection !== before.selection ||
    now.isReadOnly !== before.isReadOnly ||
    now.connection !== before.connection
  );
}

function mayChange(state: State): boolean {
  return !state.isReadOnly && state.connection === 'open';
}

function rowsOf(state: State, filter: string, actions: Actions): Node[] {
  const scene = state.scene;
  if (!scene) return [make('p', { class: 'cw-empty', text: 'The scene is not known yet.' })];
  const words = filter.trim().toLocaleLowerCase();
  const found = scene.objects.filter((object) => object.name.toLocaleLowerCase().includes(words));
  const selected = state.selection && 'object' in state.selection ? state.selection.object : undefined;
  // The selected object is listed even if it is far down, as it may have been selected in the picture.
  const shown = found.slice(0, kMostRows);
  const chosen = found.find((object) => object.name === selected);
  if (chosen && !shown.includes(chosen)) shown.unshift(chosen);
  const more = found.length - shown.length;
  const head = `${counted(scene.objects.length, 'object')}, ${counted(scene.scene.triangles, 'triangle')}`;
  return [
    make('p', { class: 'cw-muted', text: words ? `${found.length} of ${head}` : head }),
    make('ol', { class: 'cw-list', 'aria-label': 'Objects' }, ...shown.map((object) => rowOf(state, object, object.name === selected, actions))),
    ...(more > 0 ? [make('p', { class: 'cw-muted', text: `${counted(more, 'other')} not listed: type a part of the name.` })] : []),
    ...(scene.warnings ? [make('p', { class: 'cw-muted', text: scene.warnings })] : []),
  ];
}

function rowOf(state: State, object: ObjectFacts, isSelected: boolean, actions: Actions): HTMLElement {
  const button = makeButton('', () => {
    actions.select(isSelected ? undefined : { object: object.name });
    if (!isSelected) actions.showSelection();
  }, { class: 'cw-item' });
  button.dataset['key'] = `object ${object.name}`;
  if (isSelected) button.setAttribute('aria-current', 'true');
  button.append(
    make('span', { class: 'cw-item-name', text: object.name }),
    make('span', { class: 'cw-item-detail', text: `${object.kind}, ${counted(object.triangles, 'triangle')}` }),
  );
  const row = make('li', {}, button);
  if (isSelected && mayChange(state)) {
    const remove = makeButton('Remove', () => actions.removeObject(object.name), { 'aria-label': `Remove ${object.name}` });
    remove.dataset['key'] = 'remove';
    row.append(remove);
  }
  return row;
}

/** The form that adds a box or a sphere where the view looks at. */
function adderOf(store: Store, actions: Actions): HTMLFormElement {
  const form = make('form', { class: 'cw-adder', 'aria-label': 'Add an object' });
  const kind = make('select', { 'aria-label': 'Form' });
  kind.append(new Option('box', 'box'), new Option('sphere', 'sphere'));
  const name = make('input', { type: 'text', placeholder: 'name', 'aria-label': 'Name', maxlength: '200' });
  const sizes = ['x', 'y', 'z'].map((axis) => make('input', { type: 'text', inputmode: 'decimal', value: kDefaultSize_m, 'aria-label': `Size along ${axis}, m`, title: `Size along ${axis}, m` }));
  const radius = make('input', { type: 'text', inputmode: 'decimal', value: '0.25', 'aria-label': 'Radius, m', title: 'Radius, m' });
  const said = make('p', { class: 'cw-bad', role: 'alert' });
  const showSizes = (): void => {
    const isBox = kind.value === 'box';
    for (const input of sizes) input.hidden = !isBox;
    radius.hidden = isBox;
  };
  kind.addEventListener('change', showSizes);
  showSizes();
  form.append(
    make('h3', { text: 'Add an object' }),
    make('div', { class: 'cw-row' }, kind, name),
    make('div', { class: 'cw-row cw-sizes' }, ...sizes, radius, make('span', { class: 'cw-unit', text: 'm' })),
    make('div', { class: 'cw-row' }, make('button', { type: 'submit', text: 'Add where the view looks' })),
    said,
  );
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    const shape = formOf(kind.value, sizes.map((input) => numberOf(input.value)), numberOf(radius.value));
    said.textContent = shape ? '' : 'A size is a number above 0, in metres.';
    if (!shape) return;
    actions.addObject({ name: name.value.trim() || freeName(store.now, kind.value), form: shape });
    name.value = '';
  });
  return form;
}

function formOf(kind: string, sizes: readonly (number | undefined)[], radius: number | undefined): ObjectForm | undefined {
  const isSize = (value: number | undefined): value is number => value !== undefined && value > 0 && Number.isFinite(value);
  if (kind === 'sphere') return isSize(radius) ? { type: 'sphere', radius_m: radius } : undefined;
  const [x, y, z] = sizes;
  return isSize(x) && isSize(y) && isSize(z) ? { type: 'box', size: [x, y, z] } : undefined;
}

/** A name that no object has: adding by a name that exists would replace the object. */
function freeName(state: State, kind: string): string {
  const names = new Set(state.scene?.objects.map((object) => object.name));
  let number = 1;
  while (names.has(`${kind}_${number}`)) ++number;
  return `${kind}_${number}`;
}
