// SPDX-License-Identifier: MIT
import type { Answer, Segment } from '../contract/answer.js';
import type { Compared, SceneDescription } from '../contract/door.js';
import type { PlanRequest } from '../contract/request.js';
import type { Pose } from './actions.js';

/** Everything that the views of the page show. Values are replaced, never changed in place. */
export interface State {
  readonly request: PlanRequest | undefined;
  /** The answer to `request`, or to an older one while `isPending`. */
  readonly answer: Answer | undefined;
  /** Why there is no answer to `request`, as a sentence: it was refused, cancelled or could not be asked. Else empty. */
  readonly unplanned: string;
  /** The path as interpolated through the keyframes of the request. */
  readonly before: readonly Segment[];
  /** The other answer to `request`, where two are compared. */
  readonly compared: Compared | undefined;
  readonly isPending: boolean;
  /** Whether the answer is of a drag that goes on. */
  readonly isDraft: boolean;
  readonly scene: SceneDescription | undefined;
  /** Poses of objects that were asked for and are not yet in `scene`, by the name of the object. */
  readonly moves: ReadonlyMap<string, Pose>;
  /** The instant on the path that all views show, in seconds. */
  readonly cursor_s: number;
  readonly isPlaying: boolean;
  /** Index of the selected keyframe of the request, or the name of the selected object. */
  readonly selection: { keyframe: number } | { object: string } | undefined;
  /** `connecting` until the door has answered for the first time. */
  readonly connection: 'connecting' | 'open' | 'lost' | 'review';
  readonly watched: 'off' | 'ok' | 'broken' | 'replanning';
  readonly message: string;
  readonly isReadOnly: boolean;
}

/** Whether `answer` is the whole answer to `request`: neither one to an older request, nor that of a drag. */
export function isAnswered(now: Pick<State, 'answer' | 'isPending' | 'isDraft'>): boolean {
  return now.answer !== undefined && !now.isPending && !now.isDraft;
}

export type Listener = (now: State, before: State) => void;

/** Holds the state and tells its listeners of changes, once for each call of `set`. */
export class Store {
  private listeners: Listener[] = [];

  constructor(private state: State) {}

  get now(): State {
    return this.state;
  }

  set(change: Partial<State>): void {
    const before = this.state;
    this.state = { ...before, ...change };
    for (const listener of this.listeners) listener(this.state, before);
  }

  listen(listener: Listener): void {
    this.listeners.push(listener);
  }
}

export const kEmptyState: State = {
  request: undefined,
  answer: undefined,
  unplanned: '',
  before: [],
  compared: undefined,
  isPending: false,
  isDraft: false,
  scene: undefined,
  moves: new Map(),
  cursor_s: 0,
  isPlaying: false,
  selection: undefined,
  connection: 'connecting',
  watched: 'off',
  message: '',
  isReadOnly: false,
};
