// SPDX-License-Identifier: MIT
// Shows the review of a request above the report. The review is a page of its own, in a frame: it has the layout, the
// keys and the policy of a review that is opened as a file.

import { makeButton, make } from '../panels/dom.js';
import type { Shelf } from './shelf.js';

export class Viewer {
  private readonly dialog = make('dialog', { class: 'viewer', 'aria-label': 'Review of a request' });
  private readonly title = make('strong');
  private readonly reason = make('span', { class: 'reason' });
  private frame: HTMLIFrameElement | undefined;
  private shown: string | undefined;

  constructor(
    private readonly shelf: Shelf,
    /** The numbers of the requests that can be shown, in the order of the table. */
    private readonly numbers: () => string[],
    /** Title of a request, and the reason of its verdict. */
    private readonly wordsOf: (number: string) => { title: string; reason: string },
  ) {
    const step = (by: number): HTMLButtonElement =>
      makeButton(by < 0 ? 'Previous' : 'Next', () => this.step(by), { title: `The ${by < 0 ? 'previous' : 'next'} request of the table` });
    const close = makeButton('Close', () => this.dialog.close());
    this.dialog.append(make('header', {}, this.title, this.reason, step(-1), step(1), close));
    this.dialog.addEventListener('close', () => this.dropFrame());
    document.body.append(this.dialog);
  }

  show(number: string): void {
    const page = this.shelf.page(number);
    if (page === undefined) return;
    const { title, reason } = this.wordsOf(number);
    this.shown = number;
    this.title.textContent = title;
    this.reason.textContent = reason;
    this.dropFrame();
    this.frame = make('iframe', { title });
    this.frame.srcdoc = page;
    this.dialog.append(this.frame);
    if (!this.dialog.open) this.dialog.showModal();
    this.frame.focus();
  }

  private step(by: number): void {
    const numbers = this.numbers();
    const at = numbers.indexOf(this.shown ?? '');
    const next = numbers[(at + by + numbers.length) % numbers.length];
    if (next !== undefined) this.show(next);
  }

  /** A frame that is gone gives back the memory of its pictures. */
  private dropFrame(): void {
    this.frame?.remove();
    this.frame = undefined;
  }
}
