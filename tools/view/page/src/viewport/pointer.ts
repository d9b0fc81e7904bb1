// SPDX-License-Identifier: MIT
// The mouse in the view: a click selects, a keyframe follows the hand, and everything else turns the view.

import { Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { PerspectiveCamera, Ray } from 'three';
import type { Hit } from './scene_view.js';

const kReach_px = 13;
const kStill_px = 4;
/** Flatter than that to the plane of the drag, a pixel would be metres. */
const kLeastIncidence = 0.17;

export interface PointerTarget {
  readonly element: HTMLElement;
  readonly camera: PerspectiveCamera;
  /** The upward direction. */
  up(): Vector3;
  /** Whether a drag may begin, and not the handles or a picture have the mouse. */
  canDrag(): boolean;
  isTaken(): boolean;
  keyframePlaces(): readonly Vector3[];
  pick(ray: Ray): Hit | undefined;
  onSelectKeyframe(index: number): void;
  onSelectObject(hit: Hit | undefined): void;
  onFocus(point: Vector3): void;
  /** A keyframe is in the hand; `surface` is the place on the scene if it shall lie there. */
  onDrag(index: number, place: Vector3, surface: Hit | undefined): void;
  onRelease(index: number): void;
  setNavigation(isEnabled: boolean): void;
}

export class Pointer {
  private press: { at: Vector2; keyframe: number | undefined; plane: Plane; offset: Vector3; isMoved: boolean } | undefined;

  constructor(private readonly target: PointerTarget) {
    const { element } = target;
    // Ahead of the listeners of the navigation, which stands on the same element.
    element.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    element.addEventListener('pointermove', (event) => this.move(event), { capture: true });
    element.addEventListener('pointerup', (event) => this.up(event), { capture: true });
    element.addEventListener('pointercancel', () => this.end(), { capture: true });
    element.addEventListener('dblclick', (event) => this.focus(event));
  }

  get isDragging(): boolean {
    return this.press?.keyframe !== undefined && this.press.isMoved;
  }

  private at(event: MouseEvent): Vector2 {
    const box = this.target.element.getBoundingClientRect();
    return new Vector2(event.clientX - box.left, event.clientY - box.top);
  }

  private rayAt(point: Vector2): Ray {
    const { clientWidth, clientHeight } = this.target.element;
    const caster = new Raycaster();
    const clip = new Vector2((2 * point.x) / clientWidth - 1, 1 - (2 * point.y) / clientHeight);
    caster.setFromCamera(clip, this.target.camera);
    return caster.ray;
  }

  private keyframeAt(point: Vector2): number | undefined {
    const { clientWidth, clientHeight } = this.target.element;
    const place = new Vector3();
    let best: number | undefined;
    let bestDistance = kReach_px;
    this.target.keyframePlaces().forEach((candidate, i) => {
      place.copy(candidate).project(this.target.camera);
      if (Math.abs(place.z) > 1) return;
      const x = (place.x * 0.5 + 0.5) * clientWidth;
      const y = (0.5 - place.y * 0.5) * clientHeight;
      const distance = Math.hypot(x - point.x, y - point.y);
      if (distance < bestDistance) [best, bestDistance] = [i, distance];
    });
    return best;
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || this.target.isTaken()) return;
    const point = this.at(event);
    const keyframe = this.keyframeAt(point);
    const place = keyframe === undefined ? undefined : this.target.keyframePlaces()[keyframe];
    const plane = this.dragPlane(place ?? new Vector3());
    const offset = new Vector3();
    if (place) {
      const met = this.rayAt(point).intersectPlane(plane, new Vector3());
      if (met) offset.copy(place).sub(met);
    }
    this.press = { at: point, keyframe, plane, offset, isMoved: false };
    if (keyframe === undefined) return;
    this.target.setNavigation(false);
    this.target.onSelectKeyframe(keyframe);
    this.target.element.setPointerCapture(event.pointerId);
  }

  /** The level plane through a place, or one that faces the eye if that is seen edge on. */
  private dragPlane(place: Vector3): Plane {
    const toEye = this.target.camera.position.clone().sub(place).normalize();
    const isFlat = Math.abs(toEye.dot(this.target.up())) < kLeastIncidence;
    return new Plane().setFromNormalAndCoplanarPoint(isFlat ? toEye : this.target.up(), place);
  }

  private move(event: PointerEvent): void {
    const point = this.at(event);
    const { press } = this;
    if (!press) {
      const isOver = event.buttons === 0 && this.keyframeAt(point) !== undefined;
      this.target.element.dataset['over'] = isOver ? 'keyframe' : '';
      return;
    }
    press.isMoved ||= press.at.distanceTo(point) > kStill_px;
    if (press.keyframe === undefined || !press.isMoved || !this.target.canDrag()) return;
    const ray = this.rayAt(point);
    if (event.shiftKey) {
      const hit = this.target.pick(ray);
      if (hit) this.target.onDrag(press.keyframe, hit.point, hit);
      return;
    }
    const met = ray.intersectPlane(press.plane, new Vector3());
    if (met) this.target.onDrag(press.keyframe, met.add(press.offset), undefined);
  }

  private up(event: PointerEvent): void {
    const { press } = this;
    if (!press || event.button !== 0) return;
    this.end();
    if (press.isMoved || press.keyframe !== undefined) return;
    this.target.onSelectObject(this.target.pick(this.rayAt(press.at)));
  }

  private end(): void {
    const { press } = this;
    this.press = undefined;
    if (press?.keyframe === undefined) return;
    this.target.setNavigation(true);
    if (press.isMoved) this.target.onRelease(press.keyframe);
  }

  private focus(event: MouseEvent): void {
    const hit = this.target.pick(this.rayAt(this.at(event)));
    if (hit) this.target.onFocus(hit.point);
  }
}
