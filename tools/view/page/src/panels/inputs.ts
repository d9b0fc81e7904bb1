// SPDX-License-Identifier: MIT
import { make, uniqueId } from './dom.js';
import type { Range } from './ranges.js';
import { isWithin, wrongText } from './ranges.js';

export interface NumberSettings {
  /** Kept over rendering, so that the focus is. */
  key: string;
  placeholder?: string;
  range?: Range;
  isWhole?: boolean;
  /** Id of the text that describes the field. */
  describedBy?: string;
}

/** The number that a text is; undefined for an empty one, NaN for one that is no number. */
export function numberOf(text: string): number | undefined {
  const trimmed = text.trim();
  if (trimmed === '') return undefined;
  // People in many countries write 0,5.
  return Number(/^[^.]*,[^,.]*$/.test(trimmed) ? trimmed.replace(',', '.') : trimmed);
}

/**
 * A labelled field for a number. `changed` gets the number when it is right and differs, and `undefined` when the
 * field was emptied. A wrong one is marked, with a sentence beside it, and not passed on.
 */
export function numberInput(
  name: string,
  value: number | undefined,
  settings: NumberSettings,
  changed: (value: number | undefined) => void,
): HTMLElement {
  const input = numberField(value, settings, changed);
  input.id = uniqueId();
  return make('label', { class: 'cw-field', for: input.id }, make('span', { text: name }), input);
}

/** The field of `numberInput` without its label. */
export function numberField(
  value: number | undefined,
  settings: NumberSettings,
  changed: (value: number | undefined) => void,
): HTMLInputElement {
  const shown = value === undefined ? '' : String(value);
  const input = make('input', {
    type: 'text',
    inputmode: 'decimal',
    autocomplete: 'off',
    value: shown,
    placeholder: settings.placeholder,
    'data-key': settings.key,
    'aria-describedby': settings.describedBy,
  });
  const wrong = make('span', { class: 'cw-bad cw-wrong', role: 'alert' });
  const accept = (): void => {
    input.removeAttribute('aria-invalid');
    wrong.remove();
  };
  const read = (): void => {
    const next = numberOf(input.value);
    const isRight = next === undefined || (isWithin(settings.range, next) && (!settings.isWhole || Number.isSafeInteger(next)));
    accept();
    if (!isRight) {
      input.setAttribute('aria-invalid', 'true');
      wrong.textContent = wrongText(settings.range, settings.isWhole);
      input.after(wrong);
    } else if (next !== value) changed(next);
  };
  input.addEventListener('change', read);
  input.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    input.value = shown;
    accept();
  });
  return input;
}
