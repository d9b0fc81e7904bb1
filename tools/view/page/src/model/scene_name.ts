// SPDX-License-Identifier: MIT
import type { PlanRequest } from '../contract/request.js';

/** The name of the scene that a request means: a path is cut to its file's stem, as the door does. */
export function sceneStem(scene: string | undefined): string | undefined {
  return scene?.replace(/^.*[/\\]/, '').replace(/\.[^.]*$/, '');
}

/**
 * Why a request is not for the scene that is shown, as a sentence; undefined if it is, or names none. The keyframes of
 * another scene would be drawn in walls that they have nothing to do with.
 */
export function sceneFault(request: PlanRequest, shown: string | undefined): string | undefined {
  const { scene } = request;
  if (!scene || shown === undefined || scene === shown || sceneStem(scene) === shown) return undefined;
  return `This request is for the scene '${sceneStem(scene)}', and this page shows '${shown}'. Start camway view with that scene to open it.`;
}
