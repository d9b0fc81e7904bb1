// SPDX-License-Identifier: MIT
// The door of `camway view`, behind the page.

import type { PlanRequest } from '../contract/request.js';
import { sceneFault, sceneStem } from '../model/scene_name.js';
import type { Store } from '../model/store.js';
import type { Backing, PageParts } from '../page.js';
import { kDefaultCamera } from '../viewport/bodies.js';
import { PathWatch, SceneWatch } from './live.js';
import {
  describeScene,
  fetchExport,
  fetchFields,
  fetchLast,
  fetchMesh,
  fetchPart,
  fetchReview,
  fetchStatus,
  fetchTriangles,
  listScenes,
} from './places.js';
import { completed, kProfileOption, Planner } from './planner.js';
import { SceneEditor } from './scene_editor.js';
import { DoorError, DoorSocket } from './socket.js';

const kForbidden = 403;
/** Time between attempts to open a page whose door does not answer. */
const kStartPause_ms = 2000;
const kLost = 'The connection to camway is lost. The page goes on when it is back.';
const kRestarted =
  'Camway was started again, and refuses this page. Save your request first, then open the newly printed address.';

/** The sentence about a door that is lost, by the error with which it answers now. */
export function lostMessage(error: unknown): string {
  return error instanceof DoorError && error.code === kForbidden ? kRestarted : kLost;
}

/** Fills the store from the door, and follows its scene, its path and its connection. */
class Door {
  private sceneName: string | undefined;
  private wasOpen: boolean | undefined;
  private isProfileMissing = false;
  private lostWords: string = kLost;
  private readonly socket: DoorSocket;
  private readonly planner: Planner;
  private readonly scenes: SceneWatch;
  private readonly watch: PathWatch;
  private readonly sceneEditor: SceneEditor;

  constructor(
    private readonly store: Store,
    private readonly page: PageParts,
  ) {
    const nameNow = (): string | undefined => this.sceneName;
    this.socket = new DoorSocket(`ws://${location.host}/v1/socket`, (isOpen) => this.onConnection(isOpen));
    this.planner = new Planner(this.socket, store);
    this.scenes = new SceneWatch(this.socket, store, nameNow, (isChanged) => this.onScene(isChanged));
    this.watch = new PathWatch(this.socket, store, (request) => this.planner.asking(request));
    this.sceneEditor = new SceneEditor(nameNow, {
      onChanged: () => this.scenes.refresh(),
      onMoves: (moves) => store.set({ moves }),
      onError: this.onError,
    });
  }

  backing(): Backing {
    return {
      sources: {
        mesh: (digest) => fetchMesh(this.sceneName ?? '', digest),
        triangles: (indices) => fetchTriangles(this.sceneName ?? '', indices),
        part: (point, reach_m) => fetchPart(this.sceneName ?? '', point, reach_m),
      },
      request: undefined,
      facts: { fields: [], exports: [], status: undefined },
      plan: (request, kind) => this.planner.plan(request, kind),
      sceneFault: (request) => sceneFault(request, this.sceneName),
      cancelPlan: () => this.planner.cancel(),
      watchPath: (request) => (request ? this.watch.start(request) : this.watch.stop()),
      review: fetchReview,
      exported: fetchExport,
      sceneEditor: this.sceneEditor,
      start: () => void this.startUntilDone(),
    };
  }

  private readonly onError = (message: string): void => this.store.set({ message });

  private onConnection(isOpen: boolean): void {
    const isBack = isOpen && this.wasOpen === false;
    this.wasOpen = isOpen;
    this.store.set({
      connection: isOpen ? 'open' : 'lost',
      isPending: false,
      ...(isOpen ? {} : { watched: 'off', message: this.lostWords }),
    });
    if (!isOpen) {
      void this.learnWhyLost();
      return;
    }
    this.lostWords = kLost;
    this.scenes.start();
    if (isBack) {
      this.store.set({ message: 'Connected again.' });
      this.sceneEditor.resume();
      void this.scenes.refresh();
      this.watch.resume();
    }
    const { request, answer, watched } = this.store.now;
    // The watch plans a path that is watched.
    const isDue = watched === 'off' && (isBack || this.isProfileMissing || !answer);
    if (request && isDue) this.planner.plan(request, 'full');
    this.isProfileMissing = false;
  }

  /** A process that was started again has another token; the socket alone does not tell that from no process. */
  private async learnWhyLost(): Promise<void> {
    try {
      await fetchStatus();
    } catch (error) {
      this.lostWords = lostMessage(error);
      if (this.store.now.connection === 'lost') this.onError(this.lostWords);
    }
  }

  private onScene(isChanged: boolean): void {
    // A changed scene makes the answer one of another scene: plan anew, unless a daemon does so for the watched path.
    const { request, watched, unplanned } = this.store.now;
    if (request && (isChanged ? watched === 'off' : unplanned !== '')) this.planner.plan(request, 'full');
  }

  private async start(): Promise<void> {
    const [status, list, last] = await Promise.all([fetchStatus(), listScenes(), fetchLast().catch(() => ({}) as never)]);
    this.sceneName = status.backend?.scene ?? sceneStem(last.request?.scene) ?? list[0]?.name;
    const scene = this.sceneName;
    this.store.set({ isReadOnly: status.read_only === true });
    this.page.setFacts({ status: status.backend });
    const { fields, exports } = await fetchFields().catch(() => ({ fields: [], exports: [] }));
    this.page.setFacts({ fields, exports });
    this.planner.hasProfile = fields.some(({ name }) => name === kProfileOption);
    if (scene) this.store.set({ scene: await describeScene(scene) });
    const request: PlanRequest = last.request ?? { ...(scene ? { scene } : {}), camera: kDefaultCamera, keyframes: [] };
    this.page.load(request, last.answer && completed(last.answer));
    const fault = sceneFault(request, scene);
    if (fault) this.onError(fault);
    if (last.answer && this.store.now.answer) {
      this.planner.interpolate(request, this.store.now.answer);
      // The answer is shown at once; the profile that it lacks comes with a plan of the page's own.
      this.isProfileMissing = this.planner.hasProfile && last.answer.clearance_profile === undefined;
    }
    this.socket.open();
  }

  /** A door that is not reached, or has no daemon yet, is asked again; one that refuses the page is not. */
  private async startUntilDone(): Promise<void> {
    for (;;) {
      try {
        await this.start();
        return;
      } catch (error) {
        const isRefused = error instanceof DoorError && error.code === kForbidden;
        this.onError(error instanceof DoorError && !isRefused ? error.message : lostMessage(error));
        if (isRefused) return;
      }
      await new Promise((done) => setTimeout(done, kStartPause_ms));
    }
  }
}

export function openDoor(store: Store, page: PageParts): Backing {
  return new Door(store, page).backing();
}
