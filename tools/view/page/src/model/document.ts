// SPDX-License-Identifier: MIT
import type { PlanRequest } from '../contract/request.js';

/** Steps that can be undone. Requests share what an edit did not change, so a step costs little. */
const kMaxSteps = 200;

/** Bound for requests of very many keyframes: each step has an array of them. */
const kMaxKeptKeyframes = 2_000_000;

/** A request with its history. Requests are values: each edit gives a new one, and undo returns the very old one. */
export class RequestDocument {
  private past: PlanRequest[] = [];
  private future: PlanRequest[] = [];
  private saved: PlanRequest;
  /** The drag that the current request belongs to: its next frame replaces the request. */
  private drag: string | undefined;

  constructor(
    private request: PlanRequest,
    /** Name of the file, without folder. */
    public name: string,
  ) {
    this.saved = request;
  }

  get current(): PlanRequest {
    return this.request;
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** Whether the request differs from the file. */
  get isDirty(): boolean {
    return this.request !== this.saved;
  }

  /**
   * Makes `next` the request, as one step of undo. Frames of one drag have the same `drag`, a name of the caller's
   * choice, and are one step together; `endDrag` ends it. Returns whether something changed.
   */
  apply(next: PlanRequest, drag?: string): boolean {
    const goesOn = drag !== undefined && drag === this.drag;
    this.drag = drag;
    if (next === this.request) return false;
    if (!goesOn) {
      this.past.push(this.request);
      this.forgetOldest();
    }
    this.future = [];
    this.request = next;
    return true;
  }

  endDrag(): void {
    this.drag = undefined;
  }

  /** Returns whether there was a step to undo. */
  undo(): boolean {
    return this.step(this.past, this.future);
  }

  /** Returns whether there was a step to do again. */
  redo(): boolean {
    return this.step(this.future, this.past);
  }

  /** Remembers that the current request is what the file holds. */
  markSaved(): void {
    this.saved = this.request;
  }

  private step(from: PlanRequest[], to: PlanRequest[]): boolean {
    this.endDrag();
    const request = from.pop();
    if (!request) return false;
    to.push(this.request);
    this.request = request;
    return true;
  }

  private forgetOldest(): void {
    const keyframes = Math.max(1, this.request.keyframes.length);
    const most = Math.max(1, Math.min(kMaxSteps, Math.floor(kMaxKeptKeyframes / keyframes)));
    if (this.past.length > most) this.past.splice(0, this.past.length - most);
  }
}
