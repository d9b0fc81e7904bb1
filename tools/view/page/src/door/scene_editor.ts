// SPDX-License-Identifier: MIT
// Changes of the scene: of the moves of an object, one is under way, and the newest waits.

import type { NewObject, Pose } from '../model/actions.js';
import { addObject, moveObject, removeObject } from './places.js';
import { DoorError } from './socket.js';

const kUnreached = 'The change of the scene did not reach camway.';
/** The door allows 50 changes a second, of all clients together. */
const kLeastPause_ms = 60;

export class SceneEditor {
  private readonly waiting = new Map<string, Pose>();
  private isMoving = false;
  /** The move that is under way. */
  private moving: Promise<boolean> = Promise.resolve(true);

  constructor(
    private readonly sceneName: () => string | undefined,
    private readonly onChanged: () => void,
    private readonly onError: (sentence: string) => void,
  ) {}

  move(name: string, pose: Pose): void {
    this.waiting.set(name, pose);
    if (!this.isMoving) void this.moveAll();
  }

  private async moveAll(): Promise<void> {
    this.isMoving = true;
    for (let next = this.takeNext(); next; next = this.takeNext()) {
      const [name, pose] = next;
      this.moving = this.change((scene) => moveObject(scene, name, pose));
      if (!(await this.moving)) {
        // The door has not received it: `resume` sends it again, unless the object was moved on since.
        if (!this.waiting.has(name)) this.waiting.set(name, pose);
        break;
      }
      await new Promise((done) => setTimeout(done, kLeastPause_ms));
    }
    this.isMoving = false;
  }

  /** The connection is back: sends the moves that did not get through. */
  resume(): void {
    if (!this.isMoving && this.waiting.size > 0) void this.moveAll();
  }

  private takeNext(): [string, Pose] | undefined {
    const [next] = this.waiting;
    if (next) this.waiting.delete(next[0]);
    return next;
  }

  add(object: NewObject): void {
    void this.change((scene) => addObject(scene, object));
  }

  /** Removes an object after the move of it that is under way; those that wait are dropped. */
  remove(name: string): void {
    this.waiting.delete(name);
    void this.moving.then(() => {
      this.waiting.delete(name); // a move that did not get through waits again
      return this.change((scene) => removeObject(scene, name));
    });
  }

  /** Returns false where the door was not reached. A refusal is shown, and not sent again. */
  private async change(act: (scene: string) => Promise<void>): Promise<boolean> {
    const scene = this.sceneName();
    if (!scene) return true;
    try {
      await act(scene);
      this.onChanged();
    } catch (error) {
      if (!(error instanceof DoorError)) {
        this.onError(kUnreached);
        return false;
      }
      this.onError(error.message);
      this.onChanged(); // the object that was shown dragged goes back
    }
    return true;
  }
}
