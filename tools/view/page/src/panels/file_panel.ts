// SPDX-License-Identifier: MIT
import type { ExportFormat } from '../contract/door.js';
import type { Actions, DocumentFacts, Facts } from '../model/actions.js';
import { isAnswered } from '../model/store.js';
import type { State, Store } from '../model/store.js';
import { make, makeButton, setText } from './dom.js';
import { isEditable } from './render.js';

export interface FilePanel {
  setFacts(facts: Facts): void;
  setDocument(facts: DocumentFacts): void;
}

/** The reason why a button that asks the door is disabled. */
const kNeedsDoor = 'Needs the connection to camway';

/** Makes the panel that opens and saves. In a review nothing is opened, and nothing is asked of a door. */
export function makeFilePanel(host: HTMLElement, store: Store, actions: Actions): FilePanel {
  const name = make('strong', { text: 'No request' });
  const dirty = make('span', { class: 'cw-changed' });
  const open = makeButton('Open…', () => actions.open());
  const save = makeButton('Save', () => actions.save());
  const saveAnswer = makeButton('Save the answer', () => actions.saveAnswer());
  const edit = makeButton('Edit on from the answer', () => actions.editAnswer(), { title: 'Takes the keyframes of the answer, inserted ones too, as those of the request' });
  const format = make('select', { 'aria-label': 'Format' });
  let formats: readonly ExportFormat[] = [];
  const exportButton = makeButton('Export', () => {
    const chosen = formats.find(({ name }) => name === format.value);
    if (chosen) actions.exportAs(chosen);
  });
  const review = makeButton('Save as a page', () => actions.saveReview());
  const exporting = section('Export', 'Writes a pose for each frame, for another program.', format, exportButton);
  const reviewing = section('Review', 'One HTML file with the scene, the request and the answer. It opens in any browser, without Camway.', review);
  host.append(
    make('section', {}, make('h3', { text: 'Request' }), make('p', {}, name, ' ', dirty), make('div', { class: 'cw-row' }, open, save)),
    section('Answer', 'The answer as JSON, for camway check, draw and export.', saveAnswer, edit),
    exporting,
    reviewing,
  );

  const update = (now: State): void => {
    const isThere = isAnswered(now);
    const hasPath = isThere && (now.answer?.segments?.length ?? 0) > 0;
    open.hidden = !isEditable(now);
    edit.hidden = !isEditable(now);
    reviewing.hidden = now.connection === 'review';
    exporting.hidden = now.connection === 'review' || format.options.length === 0;
    save.disabled = now.request === undefined;
    saveAnswer.disabled = !isThere;
    edit.disabled = !hasPath;
    const why = now.connection === 'open' ? '' : kNeedsDoor;
    exportButton.title = why;
    review.title = why;
    exportButton.disabled = !hasPath || now.connection !== 'open';
    review.disabled = !isThere || now.connection !== 'open';
  };
  store.listen(update);
  update(store.now);
  return {
    setFacts(facts) {
      if (facts.exports !== formats) setFormats(format, facts.exports);
      formats = facts.exports;
      update(store.now);
    },
    setDocument(facts) {
      setText(name, facts.name || 'new request');
      setText(dirty, facts.isDirty ? 'not saved' : '');
    },
  };
}

function setFormats(select: HTMLSelectElement, formats: readonly ExportFormat[]): void {
  const kept = select.value;
  select.replaceChildren(...formats.map(({ name, extension, help }) => new Option(`${name} (${extension}): ${help}`, name)));
  if (formats.some(({ name }) => name === kept)) select.value = kept;
}

function section(title: string, help: string, ...children: HTMLElement[]): HTMLElement {
  return make('section', {}, make('h3', { text: title }), make('p', { class: 'cw-help', text: help }), make('div', { class: 'cw-row' }, ...children));
}
