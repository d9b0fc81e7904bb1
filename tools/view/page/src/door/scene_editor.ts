// SPDX-License-Identifier: MIT
// Changes of the scene: of the moves of an object, one is under way, and the newest waits.

import type { NewObject, Pose } from '../model/actions.js';
import { addObject, moveObject, removeObject } from './places.js';

/** The door allows 50 changes a second, of all clients together. */
const kLeastPause_ms = 60;

export class SceneEditor {
  private readonly waiting = new Map<string, Pose>();
  private isMoving = false;

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
      await this.change((scene) => moveObject(scene, name, pose));
      await new Promise((done) => setTimeout(done, kLeastPause_ms));
    }
    this.isMoving = false;
  }

  private takeNext(): [string, Pose] | undefined {
    const [next] = this.waiting;
    if (next) this.waiting.delete(next[0]);
    return next;
  }

  add(object: NewObject): void {
    void this.change((scene) => addObject(scene, object));
  }

  remove(name: string): void {
    void this.change((scene) => removeObject(scene, name));
  }

  private async change(act: (scene: string) => Promise<void>): Promise<void> {
    const scene = this.sceneName();
    if (!scene) return;
    try {
      await act(scene);
      this.onChanged();
    } catch (error) {
      this.onError((error as Error).message);
    }
  }
}
