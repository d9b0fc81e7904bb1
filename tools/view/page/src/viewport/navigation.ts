// SPDX-License-Identifier: MIT
// Orbit about a point, or walk: then the mouse turns the head, and the wheel and the keys W A S D move.

import CameraControls from 'camera-controls';
import {
  Box3,
  MathUtils,
  Matrix4,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Sphere,
  Spherical,
  Vector2,
  Vector3,
  Vector4,
} from 'three';

import { paceOf } from './pace.js';

CameraControls.install({
  THREE: { Box3, MathUtils, Matrix4, Quaternion, Raycaster, Sphere, Spherical, Vector2, Vector3, Vector4 } as never,
});

export type NavigationMode = 'orbit' | 'walk';

/** Directions of movement, to the right, forward and up, each from -1 to 1. */
export interface Heading {
  right: number;
  forward: number;
  up: number;
}

const kWalkDistance_m = 1e-3;
const kLeastFit_m = 0.3;
const kOrbitSpeed = 0.9; // of the distance to the middle, per second
const kTransition_s = 0.16;
const kFitLift = 0.22;
const kNearShare = 0.004;
const kLeastNear_m = 0.01;

export class Navigation {
  readonly camera = new PerspectiveCamera(50, 1, 0.05, 1000);
  readonly controls: CameraControls;
  private modeNow: NavigationMode = 'orbit';
  private orbitDistance_m = 10;
  private reach_m = 100;
  private heading: Heading = { right: 0, forward: 0, up: 0 };
  private readonly lessMotion = matchMedia('(prefers-reduced-motion: reduce)');

  constructor(
    private readonly surface: HTMLElement,
    private readonly onChange: () => void,
  ) {
    this.controls = new CameraControls(this.camera, surface);
    this.controls.smoothTime = kTransition_s;
    this.controls.draggingSmoothTime = 0.04;
    this.controls.dollyToCursor = true;
    this.controls.minDistance = 0.05;
    this.controls.restThreshold = 0.002;
    this.controls.addEventListener('control', onChange);
    this.controls.addEventListener('transitionstart', onChange);
    this.controls.addEventListener('controlstart', onChange);
    this.controls.addEventListener('update', onChange);
    surface.addEventListener('wheel', (event) => this.walkByWheel(event), { passive: false });
  }

  get mode(): NavigationMode {
    return this.modeNow;
  }

  /** Switches; the eye stays where it is, and looks where it looked. */
  setMode(mode: NavigationMode): void {
    if (mode === this.modeNow) return;
    this.modeNow = mode;
    const eye = this.controls.getPosition(new Vector3());
    const target = this.controls.getTarget(new Vector3());
    const toTarget = target.sub(eye);
    if (mode === 'walk') this.orbitDistance_m = Math.max(toTarget.length(), 1);
    const isWalk = mode === 'walk';
    const distance_m = isWalk ? kWalkDistance_m : Math.min(this.orbitDistance_m, 4);
    this.setButtons(isWalk);
    this.place(eye, eye.clone().addScaledVector(toTarget.normalize(), distance_m), false);
  }

  private setButtons(isWalk: boolean): void {
    const { ACTION } = CameraControls;
    this.controls.minDistance = isWalk ? 0 : 0.05;
    this.controls.mouseButtons.wheel = isWalk ? ACTION.NONE : ACTION.DOLLY;
    this.controls.mouseButtons.right = isWalk ? ACTION.NONE : ACTION.TRUCK;
    this.controls.mouseButtons.middle = isWalk ? ACTION.NONE : ACTION.TRUCK;
    // A look around follows the hand the other way than an orbit does.
    this.controls.azimuthRotateSpeed = isWalk ? -0.35 : 1;
    this.controls.polarRotateSpeed = isWalk ? -0.35 : 1;
    this.camera.fov = isWalk ? 62 : 50;
    this.camera.updateProjectionMatrix();
  }

  setUp(up: Vector3): void {
    if (this.camera.up.equals(up)) return;
    const eye = this.controls.getPosition(new Vector3());
    const target = this.controls.getTarget(new Vector3());
    this.camera.up.copy(up);
    this.controls.updateCameraUp();
    this.place(eye, target, false);
  }

  /** How far the scene reaches, for the far plane. */
  setReach(reach_m: number): void {
    this.reach_m = reach_m;
    this.controls.maxDistance = 20 * reach_m;
  }

  /** Puts the eye there; smoothly only for people who have not asked their system for less motion. */
  place(eye: Vector3, target: Vector3, isSmooth: boolean): void {
    const isGradual = isSmooth && !this.lessMotion.matches;
    void this.controls.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, isGradual);
    this.onChange();
  }

  /** Shows a sphere from a direction (from its middle to the eye), or from where the eye is now. */
  fit(sphere: Sphere, direction: Vector3 | undefined, isSmooth: boolean): void {
    if (this.modeNow === 'walk') this.setMode('orbit');
    const eye = this.controls.getPosition(new Vector3());
    const target = this.controls.getTarget(new Vector3());
    const from = (direction ?? eye.sub(target)).clone().normalize();
    const half = Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect);
    const distance_m = Math.max(sphere.radius, Math.min(kLeastFit_m, this.reach_m)) / Math.sin(Math.atan(half));
    // A little above the middle of the sphere, as the upper edge of the view has the pictures of the camera.
    const right = this.camera.up.clone().cross(from).normalize();
    const middle = sphere.center.clone().addScaledVector(from.clone().cross(right), kFitLift * sphere.radius);
    this.place(middle.clone().addScaledVector(from, distance_m), middle, isSmooth);
  }

  /** Puts the eye at a place, to walk from there in a direction. */
  walkFrom(eye: Vector3, forward: Vector3): void {
    this.setMode('walk');
    this.place(eye, eye.clone().addScaledVector(forward, kWalkDistance_m), true);
  }

  setHeading(heading: Heading): void {
    this.heading = heading;
    this.onChange();
  }

  get isMoving(): boolean {
    return this.heading.right !== 0 || this.heading.forward !== 0 || this.heading.up !== 0;
  }

  /** Moves on; returns whether the view changed, so that another frame is due. */
  update(elapsed_s: number, isFast: boolean): boolean {
    if (this.isMoving) {
      const rate = this.modeNow === 'walk' ? paceOf(this.reach_m).speed_m_per_s : kOrbitSpeed * Math.max(this.controls.distance, 0.5);
      this.move(this.heading, rate * elapsed_s * (isFast ? 3 : 1));
    }
    const changed = this.controls.update(elapsed_s);
    const distance_m = this.modeNow === 'walk' ? 1 : this.controls.distance;
    const near = Math.max(kNearShare * distance_m, kLeastNear_m);
    const far = distance_m + 4 * this.reach_m + 10;
    if (Math.abs(near / this.camera.near - 1) > 0.05 || Math.abs(far / this.camera.far - 1) > 0.05) {
      this.camera.near = near;
      this.camera.far = far;
      this.camera.updateProjectionMatrix();
    }
    return changed || this.isMoving;
  }

  private move(heading: Heading, step_m: number): void {
    if (heading.forward !== 0) void this.controls.forward(heading.forward * step_m, false);
    if (heading.right !== 0) void this.controls.truck(heading.right * step_m, 0, false);
    if (heading.up !== 0) void this.controls.elevate(heading.up * step_m, false);
  }

  private walkByWheel(event: WheelEvent): void {
    if (this.modeNow !== 'walk') return;
    event.preventDefault();
    this.move({ right: 0, forward: -Math.sign(event.deltaY), up: 0 }, paceOf(this.reach_m).step_m);
    this.onChange();
  }

  setSize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
  }

  get element(): HTMLElement {
    return this.surface;
  }
}
