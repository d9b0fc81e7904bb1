// SPDX-License-Identifier: MIT
// Events at the door while the page is open: scenes that change, daemons that come and go, and a watched path.

import type { Answer } from '../contract/answer.js';
import type { SceneFacts } from '../contract/door.js';
import type { PlanRequest } from '../contract/request.js';
import type { Store } from '../model/store.js';
import { describeScene } from './places.js';
import { completed } from './planner.js';
import { DoorLost } from './socket.js';
import type { DoorSocket } from './socket.js';

interface SceneEvent {
  kind?: string;
  state?: { scenes?: SceneFacts[] };
  heard?: boolean;
}

interface PathEvent {
  kind?: string;
  answer?: Answer;
  error?: string;
}

/** Follows the scene that the page shows. Several changes at a time are fetched as one. */
export class SceneWatch {
  private isFetching = false;
  private fetching: Promise<void> = Promise.resolve();
  private isStale = false;

  constructor(
    private readonly socket: DoorSocket,
    private readonly store: Store,
    /** The scene that is shown; undefined for the first that there is. */
    private readonly sceneName: () => string | undefined,
    /** Hears that the scene changed, or that a daemon which was lost is back. */
    private readonly onScene: (isChanged: boolean) => void,
  ) {}

  start(): void {
    const { answer } = this.socket.ask({ do: 'watch' }, ({ event }) => this.hear(event as SceneEvent));
    answer.catch(() => undefined); // the connection says when it is back
  }

  private hear(event: SceneEvent): void {
    if (event.kind === 'daemon') {
      this.store.set(
        event.heard
          ? { connection: 'open', message: '' }
          : { connection: 'lost', message: 'The daemon is not heard. The page goes on when it is back.' },
      );
      if (event.heard) void this.refresh().then(() => this.onScene(false));
      return;
    }
    const scenes = event.state?.scenes ?? [];
    const name = this.sceneName() ?? scenes[0]?.name;
    const facts = scenes.find((scene) => scene.name === name);
    const shown = this.store.now.scene?.scene;
    if (!facts) return;
    if (!shown || shown.name !== facts.name || shown.revision !== facts.revision || shown.digest !== facts.digest) void this.refresh();
  }

  /** Fetches the description of the scene anew. Resolves when the store has one that was asked for after the call. */
  refresh(): Promise<void> {
    this.isStale = true;
    if (!this.isFetching) this.fetching = this.fetchWhileStale();
    return this.fetching;
  }

  private async fetchWhileStale(): Promise<void> {
    this.isFetching = true;
    while (this.isStale) {
      this.isStale = false;
      const name = this.sceneName();
      if (!name) break;
      try {
        const scene = await describeScene(name);
        const isChanged = this.store.now.scene !== undefined && this.store.now.scene.scene.digest !== scene.scene.digest;
        this.store.set({ scene });
        if (isChanged) this.onScene(true);
      } catch (error) {
        this.store.set({ message: (error as Error).message });
      }
    }
    this.isFetching = false;
  }
}

/** Has a daemon watch the path of a request. */
export class PathWatch {
  private id: number | undefined;
  private request: PlanRequest | undefined;
  /** The path that is followed: where there is no way for a while, it is free again later. */
  private followed: Answer | undefined;

  constructor(
    private readonly socket: DoorSocket,
    private readonly store: Store,
    /** The request as it is asked for: answers to it have all that the page shows. */
    private readonly asking: (request: PlanRequest) => PlanRequest,
  ) {}

  get isOn(): boolean {
    return this.id !== undefined;
  }

  start(request: PlanRequest): void {
    this.stop();
    const { id, answer } = this.socket.ask({ do: 'watch', request: this.asking(request) }, ({ event }) => {
      if (this.id === id) this.hear(event as PathEvent);
    });
    this.id = id;
    this.request = request;
    this.followed = undefined;
    this.store.set({ watched: 'replanning' });
    answer.then(
      () => this.ended(id, ''),
      (error: Error) => this.ended(id, error instanceof DoorLost ? '' : error.message, error instanceof DoorLost),
    );
  }

  /** Watches again where a path was watched when the connection was lost, as it was edited since. */
  resume(): void {
    if (this.id === undefined && this.request) this.start(this.store.now.request ?? this.request);
  }

  stop(): void {
    if (this.id !== undefined) this.socket.tell(this.id, 'unwatch');
    this.id = undefined;
    this.request = undefined;
    this.store.set({ watched: 'off' });
  }

  private ended(id: number, message: string, isLost = false): void {
    if (this.id !== id) return;
    this.id = undefined;
    if (!isLost) this.request = undefined;
    this.store.set({ watched: 'off', ...(message ? { message } : {}) });
  }

  private hear(event: PathEvent): void {
    const name = event.kind;
    if (event.answer) {
      const answer = completed(event.answer);
      const isBetter = name === 'better'; // it is offered, and the path that is followed stays
      if (!isBetter && answer.status === 'ok') this.followed = answer;
      this.store.set({
        ...(isBetter ? {} : { answer, unplanned: '', isDraft: false, isPending: false }),
        watched: answer.status === 'ok' ? 'ok' : 'broken',
        message: isBetter ? 'A better path is possible now: plan again to take it.' : answer.message,
      });
    } else if (name === 'broken') {
      this.store.set({ watched: 'broken', message: 'The scene changed, and the path is broken.' });
    } else if (name === 'free') {
      const answer = this.followed ? { answer: this.followed, unplanned: '', isDraft: false, isPending: false } : {};
      this.store.set({ ...answer, watched: 'ok', message: 'The path is free again.' });
    } else if (event.error) {
      this.store.set({ message: event.error });
    }
  }
}
