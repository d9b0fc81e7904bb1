// SPDX-License-Identifier: MIT
// Plans requests over the socket. Of a drag the latest request wins; answers that come late are dropped.

import type { Answer, Segment } from '../contract/answer.js';
import type { PlanRequest } from '../contract/request.js';
import type { PlanKind } from '../model/actions.js';
import { kLeastKeyframes } from '../model/edits.js';
import { withoutFault } from '../model/option_fault.js';
import type { Store } from '../model/store.js';
import { interpolate } from './places.js';
import { DoorError, DoorLost, Superseded } from './socket.js';
import type { DoorSocket } from './socket.js';

const kDrag = 'page';
/** A frame of a drag that takes longer is answered as far as it came: the hand does not wait. */
const kDraftDeadline_s = 0.2;
const kDefaultDeadline_s = 10;
/** Option of requests that adds `clearance_profile` to answers. */
export const kProfileOption = 'clearance_profile';

/** An answer in which the members that the page relies on are there; an invalid one has few. */
export function completed(answer: Answer): Answer {
  return {
    ...answer,
    segments: answer.segments ?? [],
    keyframes: answer.keyframes ?? [],
    collisions: answer.collisions ?? [],
    remaining_collisions: answer.remaining_collisions ?? [],
  };
}

function draftOf(request: PlanRequest): PlanRequest {
  const asked = request.options?.['deadline_s'];
  const deadline_s = Math.min(typeof asked === 'number' ? asked : kDefaultDeadline_s, kDraftDeadline_s);
  return { ...request, options: { ...request.options, deadline_s } };
}

/** The path before, in steps: one question is under way, and the newest one waits. */
class Interpolation {
  private next: PlanRequest | undefined;
  private isAsking = false;

  constructor(
    private readonly interpolated: (request: PlanRequest) => Promise<readonly Segment[]>,
    private readonly onPath: (request: PlanRequest, path: readonly Segment[]) => void,
  ) {}

  ask(request: PlanRequest): void {
    this.next = request;
    if (!this.isAsking) void this.run();
  }

  private async run(): Promise<void> {
    this.isAsking = true;
    for (let request = this.next; request; request = this.next) {
      this.next = undefined;
      this.onPath(request, await this.pathOf(request));
    }
    this.isAsking = false;
  }

  /** Shows the path without an option that is refused; the answer to the request names the fault. */
  private async pathOf(request: PlanRequest): Promise<readonly Segment[]> {
    for (let asked: PlanRequest | undefined = request; asked; ) {
      try {
        return await this.interpolated(asked);
      } catch (error) {
        asked = error instanceof DoorError ? withoutFault(asked, error.message) : undefined;
      }
    }
    return [];
  }
}

/** An answer with all that it is of. */
interface Answered {
  readonly request: PlanRequest;
  readonly answer: Answer;
  readonly scene: string | undefined;
}

export class Planner {
  private asked = 0;
  private shown = 0;
  private running: number | undefined;
  private answered: Answered | undefined;
  /** Whether the door has the option for profiles of the clearance. */
  hasProfile = false;
  private readonly interpolation: Interpolation;

  constructor(
    private readonly socket: Pick<DoorSocket, 'ask' | 'tell'>,
    private readonly store: Store,
    /** Asks for the path as interpolated. */
    interpolated: (request: PlanRequest) => Promise<readonly Segment[]> = interpolate,
  ) {
    this.interpolation = new Interpolation(interpolated, (request, before) => {
      if (store.now.request === request) store.set({ before });
    });
  }

  /** Asks for the path before alone: `answer` is that of `request` already. */
  interpolate(request: PlanRequest, answer: Answer): void {
    this.remember(request, answer);
    this.interpolation.ask(request);
  }

  private remember(request: PlanRequest, answer: Answer): void {
    this.answered = { request, answer, scene: this.store.now.scene?.scene.digest };
  }

  plan(request: PlanRequest, kind: PlanKind): void {
    const asked = ++this.asked;
    if (request.keyframes.length < kLeastKeyframes) {
      this.shown = asked;
      this.store.set({ answer: undefined, unplanned: '', before: [], isPending: false, isDraft: false });
      return;
    }
    this.interpolation.ask(request);
    this.store.set({ isPending: true, isDraft: kind === 'draft', unplanned: '' });
    void this.run(asked, request, kind);
  }

  cancel(): void {
    if (this.running === undefined) return;
    this.socket.tell(this.running, 'cancel');
    this.asked += 1; // whatever comes now is not wanted
    this.refused('Planning was cancelled.');
  }

  /**
   * Says why the request has no answer. An older answer goes, as what it proves is not of this request; that of this
   * request in this scene stays, where it was only to be planned again.
   */
  private refused(sentence: string): void {
    const { request, answer, scene } = this.store.now;
    const known = this.answered;
    const isOfThis = known !== undefined && known.request === request && known.answer === answer && known.scene === scene?.scene.digest;
    const left = isOfThis ? {} : { answer: undefined, unplanned: sentence };
    this.store.set({ isPending: false, isDraft: false, message: sentence, ...left });
  }

  /** The request as it is asked for: with the profile that colours the path, if the door has that option. */
  asking(request: PlanRequest): PlanRequest {
    return this.hasProfile ? { ...request, options: { [kProfileOption]: true, ...request.options } } : request;
  }

  private async run(asked: number, request: PlanRequest, kind: PlanKind): Promise<void> {
    const isDraft = kind === 'draft';
    const asking = this.asking(request);
    const question = isDraft
      ? { do: 'plan', drag: kDrag, finish: true, request: draftOf(asking) }
      : { do: 'plan', drag: kDrag, progress: true, request: asking };
    const { id, answer } = this.socket.ask(question, (part) => this.showProgress(asked, part['progress']));
    this.running = id;
    try {
      const message = await answer;
      if (message['cancelled'] === true && asked === this.asked) this.refused('Planning was cancelled.');
      if (asked < this.shown || message['cancelled'] === true) return;
      this.shown = asked;
      this.show(completed(message['answer'] as Answer), request, isDraft, asked === this.asked);
    } catch (error) {
      if (asked !== this.asked || error instanceof Superseded) return;
      this.refused(error instanceof DoorLost ? 'The connection is lost; this will be planned when it is back.' : (error as Error).message);
    } finally {
      if (this.running === id) this.running = undefined;
    }
  }

  private show(answer: Answer, request: PlanRequest, isDraft: boolean, isLast: boolean): void {
    this.store.set({
      answer,
      unplanned: '',
      isDraft: isDraft || !isLast,
      isPending: !isLast,
      ...(isLast && !isDraft ? { message: '' } : {}),
    });
    if (!isDraft && isLast) this.remember(request, answer);
  }

  private showProgress(asked: number, progress: unknown): void {
    if (asked !== this.asked || typeof progress !== 'object' || progress === null) return;
    const { stage, collisions, corrected, elapsed_s } = progress as Record<string, unknown>;
    const count = typeof collisions === 'number' && collisions > 0 ? `, ${String(corrected ?? 0)} of ${collisions} corrected` : '';
    const seconds = typeof elapsed_s === 'number' ? `, ${elapsed_s.toFixed(1)} s` : '';
    this.store.set({ message: `${String(stage)}${count}${seconds}` });
  }
}
