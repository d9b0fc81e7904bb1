// SPDX-License-Identifier: MIT
// Changes of the scene: of the moves of an object, one is under way, and the newest waits.

import type { NewObject, Pose } from '../model/actions.js';
import { addObject, moveObject, removeObject } from './places.js';
import { DoorError } from './socket.js';

const kUnreached = 'The change of the scene did not reach camway.';
/** The door allows 50 changes a second, of all clients together. */
const kLeastPause_ms = 60;

export interface SceneEditorEvents {
  /** Hears that the scene is another one now. Resolves when the store has it. */
  onChanged(): Promise<void>;
  /** Hears where objects were asked to be that are not there yet. */
  onMoves(moves: ReadonlyMap<string, Pose>): void;
  onError(sentence: string): void;
}

type Outcome = 'done' | 'refused' | 'unreached';

export class SceneEditor {
  /** The poses that were asked for, until the store has a scene with them. */
  private readonly wanted = new Map<string, Pose>();
  private readonly waiting = new Set<string>();
  private isMoving = false;
  /** The move that is under way. */
  private moving: Promise<Outcome> = Promise.resolve('done');

  constructor(
    private readonly sceneName: () => string | undefined,
    private readonly events: SceneEditorEvents,
  ) {}

  move(name: string, pose: Pose): void {
    this.want(name, pose);
    this.waiting.add(name);
    if (!this.isMoving) void this.moveAll();
  }

  private async moveAll(): Promise<void> {
    this.isMoving = true;
    for (let next = this.takeNext(); next; next = this.takeNext()) {
      const [name, pose] = next;
      this.moving = this.change((scene) => moveObject(scene, name, pose));
      const outcome = await this.moving;
      if (outcome === 'unreached') {
        this.waiting.add(name); // `resume` sends it, or where the object was moved on to since
        break;
      }
      // A refused object goes back at once. Another one stays where it is drawn until the scene has it there.
      if (outcome === 'refused') this.settle(name, pose);
      void this.events.onChanged().then(() => this.settle(name, pose));
      await new Promise((done) => setTimeout(done, kLeastPause_ms));
    }
    this.isMoving = false;
  }

  /** The connection is back: sends the moves that did not get through. */
  resume(): void {
    if (!this.isMoving && this.waiting.size > 0) void this.moveAll();
  }

  private takeNext(): [string, Pose] | undefined {
    for (const name of this.waiting) {
      this.waiting.delete(name);
      const pose = this.wanted.get(name);
      if (pose) return [name, pose];
    }
    return undefined;
  }

  private want(name: string, pose: Pose | undefined): void {
    if (pose) this.wanted.set(name, pose);
    else this.wanted.delete(name);
    this.events.onMoves(new Map(this.wanted));
  }

  /** Forgets a pose that is no longer on its way, unless the object was moved on since. */
  private settle(name: string, pose: Pose): void {
    if (this.wanted.get(name) === pose) this.want(name, undefined);
  }

  add(object: NewObject): void {
    void this.change((scene) => addObject(scene, object)).then((outcome) => this.refreshAfter(outcome));
  }

  /** Removes an object after the move of it that is under way; those that wait are dropped. */
  remove(name: string): void {
    this.waiting.delete(name);
    void this.moving.then(async () => {
      this.want(name, undefined); // a move that did not get through waits again
      this.refreshAfter(await this.change((scene) => removeObject(scene, name)));
    });
  }

  private refreshAfter(outcome: Outcome): void {
    if (outcome !== 'unreached') void this.events.onChanged();
  }

  /** A refusal is said, and not sent again. */
  private async change(act: (scene: string) => Promise<void>): Promise<Outcome> {
    const scene = this.sceneName();
    if (!scene) return 'refused';
    try {
      await act(scene);
      return 'done';
    } catch (error) {
      const isRefused = error instanceof DoorError;
      this.events.onError(isRefused ? error.message : kUnreached);
      return isRefused ? 'refused' : 'unreached';
    }
  }
}
