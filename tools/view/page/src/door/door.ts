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
/** Between attempts to open a page whose door does not answer. */
const kStartPause_ms = 2000;
const kLost = 'The connection to camway is lost. The page goes on when it is back.';
const kRestarted =
  'Camway was started again, and refuses this page. Save your request first, then open the newly printed address.';

/** What to say of a door that is lost, by the error with which it answers now. */
export function lostMessage(error: unknown): string {
  return error instanceof DoorError && error.code === kForbidden ? kRestarted : kLost;
}

export function openDoor(store: Store, page: PageParts): Backing {
  let sceneName: string | undefined;
  const nameNow = (): string | undefined => sceneName;
  const onError = (message: string): void => store.set({ message });
  let stateBefore: boolean | undefined;
  let isProfileMissing = false;
  let lostWords: string = kLost;
  /** A process that was started again has another token; the socket alone does not tell that from no process. */
  const learnWhyLost = async (): Promise<void> => {
    try {
      await fetchStatus();
    } catch (error) {
      lostWords = lostMessage(error);
      if (store.now.connection === 'lost') store.set({ message: lostWords });
    }
  };
  const socket = new DoorSocket(`ws://${location.host}/v1/socket`, (isOpen) => {
    const isBack = isOpen && stateBefore === false;
    stateBefore = isOpen;
    store.set({
      connection: isOpen ? 'open' : 'lost',
      isPending: false,
      ...(isOpen ? {} : { watched: 'off', message: lostWords }),
    });
    if (!isOpen) {
      void learnWhyLost();
      return;
    }
    lostWords = kLost;
    scenes.start();
    if (isBack) {
      store.set({ message: 'Connected again.' });
      sceneEditor.resume();
      void scenes.refresh();
      watch.resume();
    }
    const { request, answer, watched } = store.now;
    // A path that is watched is planned for that.
    if (request && watched === 'off' && (isBack || isProfileMissing || !answer)) planner.plan(request, 'full');
    isProfileMissing = false;
  });
  const planner = new Planner(socket, store);
  const scenes = new SceneWatch(socket, store, nameNow, (isChanged) => {
    // A changed scene makes the answer one of another scene: plan anew, unless a daemon does so for the watched path.
    const { request, watched, unplanned } = store.now;
    if (request && (isChanged ? watched === 'off' : unplanned !== '')) planner.plan(request, 'full');
  });
  const watch = new PathWatch(socket, store, (request) => planner.asking(request));
  const sceneEditor = new SceneEditor(nameNow, () => void scenes.refresh(), onError);

  async function start(): Promise<void> {
    const [status, list, last] = await Promise.all([fetchStatus(), listScenes(), fetchLast().catch(() => ({}) as never)]);
    sceneName = status.backend?.scene ?? sceneStem(last.request?.scene) ?? list[0]?.name;
    store.set({ isReadOnly: status.read_only === true });
    page.setFacts({ status: status.backend });
    const { fields, exports } = await fetchFields().catch(() => ({ fields: [], exports: [] }));
    page.setFacts({ fields, exports });
    planner.hasProfile = fields.some(({ name }) => name === kProfileOption);
    if (sceneName) store.set({ scene: await describeScene(sceneName) });
    const request: PlanRequest = last.request ?? { ...(sceneName ? { scene: sceneName } : {}), camera: kDefaultCamera, keyframes: [] };
    page.load(request, last.answer && completed(last.answer));
    const fault = sceneFault(request, sceneName);
    if (fault) onError(fault);
    if (last.answer && store.now.answer) {
      planner.interpolate(request, store.now.answer);
      // The answer is shown at once; the profile that it lacks comes with a plan of the page's own.
      isProfileMissing = planner.hasProfile && last.answer.clearance_profile === undefined;
    }
    socket.open();
  }

  /** A door that is not reached, or has no daemon yet, is asked again; one that refuses the page is not. */
  async function startUntilDone(): Promise<void> {
    for (;;) {
      try {
        await start();
        return;
      } catch (error) {
        const isRefused = error instanceof DoorError && error.code === kForbidden;
        onError(error instanceof DoorError && !isRefused ? error.message : lostMessage(error));
        if (isRefused) return;
      }
      await new Promise((done) => setTimeout(done, kStartPause_ms));
    }
  }

  return {
    sources: {
      mesh: (digest) => fetchMesh(sceneName ?? '', digest),
      triangles: (indices) => fetchTriangles(sceneName ?? '', indices),
      part: (point, reach_m) => fetchPart(sceneName ?? '', point, reach_m),
    },
    request: undefined,
    facts: { fields: [], exports: [], status: undefined },
    plan: (request, kind) => planner.plan(request, kind),
    sceneFault: (request) => sceneFault(request, sceneName),
    cancelPlan: () => planner.cancel(),
    watchPath: (request) => (request ? watch.start(request) : watch.stop()),
    review: fetchReview,
    exported: fetchExport,
    sceneEditor,
    start: () => void startUntilDone(),
  };
}
