// SPDX-License-Identifier: MIT
// Handles that move and turn what is selected, a keyframe or an object.

import { Object3D, Quaternion, Vector3 } from 'three';
import type { Camera, Scene } from 'three';
import { TransformControls } from 'three/addons/controls/TransformControls.js';

/** For x, y, z, and the axis in the hand: told apart by any kind of colour vision. */
const kAxisColours = [0xd55e00, 0x009e73, 0x2b86c9, 0xf0e442] as const;

export type HandleMode = 'translate' | 'rotate';

export interface HandleTarget {
  /** Tells targets apart: handles stay in the hand while the same target changes. */
  key: string;
  position: Vector3;
  orientation: Quaternion;
}

export interface HandleEvents {
  onDrag: (position: Vector3, orientation: Quaternion) => void;
  onRelease: (position: Vector3, orientation: Quaternion) => void;
  onBusy: (isBusy: boolean) => void;
  onChange: () => void;
}

export class Handles {
  private readonly proxy = new Object3D();
  private readonly controls: TransformControls;
  private target: HandleTarget | undefined;
  private moved = false;

  constructor(camera: Camera, element: HTMLElement, scene: Scene, events: HandleEvents) {
    this.controls = new TransformControls(camera, element);
    this.controls.setSize(0.75);
    this.controls.setColors(...kAxisColours);
    this.controls.setMode('translate');
    scene.add(this.proxy, this.controls.getHelper());
    this.controls.addEventListener('change', events.onChange);
    this.controls.addEventListener('objectChange', () => {
      this.moved = true;
      events.onDrag(this.proxy.position.clone(), this.proxy.quaternion.clone());
    });
    this.controls.addEventListener('dragging-changed', ({ value }) => {
      events.onBusy(value === true);
      if (value !== true && this.moved) events.onRelease(this.proxy.position.clone(), this.proxy.quaternion.clone());
      this.moved = false;
    });
  }

  /** Whether the mouse is over a handle, or has one. */
  get isHot(): boolean {
    return this.axis !== null;
  }

  /** The handle under the mouse: "X", "XZ", ...; null if there is none. */
  get axis(): string | null {
    return this.target ? this.controls.axis : null;
  }

  /** The handle that the mouse has at a place of the view, which is in clip coordinates. */
  axisAt(x: number, y: number): string | null {
    const had = this.controls.axis;
    this.controls.pointerHover({ x, y } as PointerEvent); // it reads nothing else
    const met = this.axis;
    this.controls.axis = had;
    return met;
  }

  /** Whether the mouse is over the middle, which moves in all directions at a time. */
  get isMiddleHot(): boolean {
    return this.axis === 'XYZ';
  }

  /** While they are disabled, the mouse has no handle. */
  set isEnabled(isEnabled: boolean) {
    this.controls.enabled = isEnabled;
  }

  get isDragging(): boolean {
    return this.controls.dragging;
  }

  get mode(): HandleMode {
    return this.controls.mode as HandleMode;
  }

  set mode(mode: HandleMode) {
    this.controls.setMode(mode);
    this.controls.setSpace(mode === 'rotate' ? 'local' : 'world');
  }

  show(target: HandleTarget | undefined): void {
    if (this.isDragging && target?.key === this.target?.key) return;
    this.target = target;
    if (!target) {
      this.controls.detach();
      return;
    }
    this.proxy.position.copy(target.position);
    this.proxy.quaternion.copy(target.orientation);
    this.proxy.updateMatrixWorld();
    this.controls.attach(this.proxy);
  }

  set visible(isVisible: boolean) {
    this.controls.getHelper().visible = isVisible && this.target !== undefined;
  }
}
