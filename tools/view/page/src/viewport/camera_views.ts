// SPDX-License-Identifier: MIT
// Through the camera: what it sees at the cursor, on the path and beside it on the path before. Both are parts of the
// same canvas, under two figures of the page that say which is which.

import { PerspectiveCamera } from 'three';
import type { Quaternion, Vector3 } from 'three';
import type { Compared } from '../contract/door.js';
import type { Camera } from '../contract/request.js';
import { setText } from '../panels/dom.js';
import { pictureHalf } from './bodies.js';

export type CameraMode = 'off' | 'inset' | 'full';

export interface Eye {
  position: Vector3;
  orientation: Quaternion;
  isColliding: boolean;
}

interface View {
  figure: HTMLElement;
  picture: HTMLElement;
  caption: HTMLElement;
  camera: PerspectiveCamera;
  eye: Eye | undefined;
}

/** A part of the canvas in CSS pixels, from its lower left corner. */
export interface Part {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The path that the camera of a view is on: it is named, and its line is drawn beside the name. */
export type PathShown = 'after' | 'before';

const kNames = { after: 'through the camera', before: 'before correction' } as const;
const kUncorrected = 'through the camera, path as interpolated';

export class CameraViews {
  private readonly views: Record<'after' | 'before', View>;
  private modeNow: CameraMode = 'inset';

  constructor(private readonly host: HTMLElement) {
    host.className = 'camera-views';
    host.setAttribute('aria-label', 'Through the camera');
    this.views = { after: makeView('after'), before: makeView('before') };
    host.append(this.views.before.figure, this.views.after.figure);
    this.setMode('inset');
  }

  get mode(): CameraMode {
    return this.modeNow;
  }

  setMode(mode: CameraMode): void {
    this.modeNow = mode;
    this.host.dataset['mode'] = mode;
  }

  /** Names the paths that the views are on: the first is on the path beside, where the answer has none. */
  setPath(path: PathShown, compared: Compared | undefined): void {
    const { figure, caption } = this.views.after;
    figure.dataset['path'] = path;
    const isAfter = path === 'after';
    if (compared) setText(caption, `${kNames.after}, ${isAfter ? compared.name : compared.otherName}`);
    else setText(caption, isAfter ? kNames.after : kUncorrected);
    setText(this.views.before.caption, compared ? compared.otherName : kNames.before);
  }

  setEyes(camera: Camera, after: Eye | undefined, before: Eye | undefined, far_m: number): void {
    const [x, y] = pictureHalf(camera);
    this.host.style.setProperty('--picture-aspect', String(x / y));
    for (const [view, eye] of [[this.views.after, after], [this.views.before, before]] as const) {
      view.eye = eye;
      view.figure.hidden = !eye;
      view.figure.dataset['colliding'] = String(eye?.isColliding ?? false);
      if (!eye) continue;
      view.camera.fov = Math.min(camera.fov_y_deg, 170);
      view.camera.aspect = x / y;
      view.camera.near = camera.near;
      view.camera.far = camera.near + far_m;
      view.camera.position.copy(eye.position);
      view.camera.quaternion.copy(eye.orientation);
      view.camera.updateProjectionMatrix();
      view.camera.updateMatrixWorld();
    }
    this.host.hidden = !after && !before;
  }

  /** The views that are to be drawn, and where. */
  parts(canvas: DOMRect): { camera: PerspectiveCamera; part: Part }[] {
    if (this.modeNow === 'off' || this.host.hidden) return [];
    return Object.values(this.views)
      .filter(({ eye }) => eye !== undefined)
      .map(({ picture, camera }) => {
        const box = picture.getBoundingClientRect();
        return {
          camera,
          part: { x: box.left - canvas.left, y: canvas.bottom - box.bottom, width: box.width, height: box.height },
        };
      })
      .filter(({ part }) => part.width >= 1 && part.height >= 1);
  }
}

function makeView(kind: 'after' | 'before'): View {
  const figure = document.createElement('figure');
  figure.dataset['view'] = kind;
  figure.dataset['path'] = kind;
  const picture = document.createElement('div');
  picture.className = 'picture';
  const caption = document.createElement('figcaption');
  caption.textContent = kNames[kind];
  figure.append(picture, caption);
  return { figure, picture, caption, camera: new PerspectiveCamera(), eye: undefined };
}
