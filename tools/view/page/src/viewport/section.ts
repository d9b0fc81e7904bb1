// SPDX-License-Identifier: MIT
// The section plane and the storeys: a slider for the height of the cut, and a button for each floor.

import { Vector3, Vector4 } from 'three';
import type { IUniform } from 'three';

/** The cut through a storey lies that far above its floor, if the storey is that high: above heads and doors. */
const kCutAboveFloor_m = 2.2;
/** Room that is left above the path when the view opens by itself. */
const kCutAbovePath_m = 0.7;
const kSteps = 400;

export class Section {
  /** Heights along `up` in the frame that is drawn. */
  private range: [number, number] = [0, 1];
  private floors: number[] = [];
  private up = new Vector3(0, 1, 0);
  private height = Infinity;
  private isPaused = false;
  private zero = 0;
  private readonly slider = document.createElement('input');
  private readonly readout = document.createElement('output');
  private readonly storeys = document.createElement('div');

  constructor(
    private readonly host: HTMLElement,
    private readonly plane: IUniform<Vector4>,
    private readonly onChange: () => void,
  ) {
    host.className = 'section-tool';
    host.setAttribute('role', 'group');
    host.setAttribute('aria-label', 'Section');
    this.slider.type = 'range';
    this.slider.min = '0';
    this.slider.max = String(kSteps);
    this.slider.setAttribute('aria-label', 'Height of the section');
    this.slider.dataset['section'] = 'height';
    this.slider.addEventListener('input', () => {
      const share = Number(this.slider.value) / kSteps;
      this.cutAt(share >= 1 ? Infinity : this.range[0] + share * (this.range[1] - this.range[0]));
    });
    this.storeys.className = 'storeys';
    const name = document.createElement('span');
    name.textContent = 'Section';
    host.append(name, this.slider, this.readout, this.storeys);
  }

  /** Sets the extent of the scene along `up`, and its floors; `zero` is the height of the frame's origin. */
  setScene(up: Vector3, range: [number, number], floors: readonly number[], zero: number): void {
    this.up = up;
    this.range = range;
    this.zero = zero;
    // A roof is a floor, too, but nobody walks below the sky.
    this.floors = floors.filter((floor) => floor < range[1] - 1);
    this.storeys.replaceChildren(
      ...this.floors.map((_, i) => this.makeButton(String(i), `Storey ${i}`, () => this.pickStorey(i))),
      this.makeButton('all', 'No section', () => this.cutAt(Infinity)),
    );
    this.apply();
  }

  private makeButton(text: string, label: string, act: () => void): HTMLButtonElement {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = text;
    button.title = label;
    button.setAttribute('aria-label', label);
    button.dataset['storey'] = text;
    button.addEventListener('click', act);
    return button;
  }

  get storeyCount(): number {
    return this.floors.length;
  }

  get cutHeight(): number {
    return this.height;
  }

  pickStorey(index: number): void {
    const floor = this.floors[index];
    if (floor !== undefined) this.cutAt(this.cutOf(index, floor));
  }

  private cutOf(index: number, floor: number): number {
    const next = this.floors[index + 1] ?? this.range[1];
    return floor + Math.min(kCutAboveFloor_m, 0.75 * (next - floor));
  }

  /** Opens the scene above a path that lies below something. */
  openAbove(pathTop: number): void {
    this.cutAt(this.range[1] > pathTop + 2 * kCutAbovePath_m ? pathTop + kCutAbovePath_m : Infinity);
  }

  toggle(pathTop: number): void {
    if (this.height < Infinity) this.cutAt(Infinity);
    else this.cutAt(Math.min(pathTop + kCutAbovePath_m, this.range[1]));
  }

  cutAt(height: number): void {
    this.height = height;
    this.apply();
  }

  /** While it is paused nothing is cut: people who walk want to see the ceiling. */
  pause(isPaused: boolean): void {
    if (this.isPaused === isPaused) return;
    this.isPaused = isPaused;
    this.apply();
  }

  /** Runs `draw` without the section. */
  without(draw: () => void): void {
    const kept = this.plane.value.clone();
    this.plane.value.set(0, 0, 0, 0);
    draw();
    this.plane.value.copy(kept);
  }

  private apply(): void {
    const isOff = this.height === Infinity || this.isPaused;
    this.plane.value.set(isOff ? 0 : this.up.x, isOff ? 0 : this.up.y, isOff ? 0 : this.up.z, isOff ? 0 : this.height);
    const share = (Math.min(this.height, this.range[1]) - this.range[0]) / (this.range[1] - this.range[0] || 1);
    this.slider.value = String(Math.round(kSteps * share));
    this.readout.textContent = this.height === Infinity ? 'off' : `${(this.height + this.zero).toFixed(2)} m`;
    this.slider.setAttribute('aria-valuetext', this.readout.textContent);
    this.storeys.querySelectorAll('button').forEach((button, i) => {
      const floor = this.floors[i];
      const isOn = floor === undefined ? this.height === Infinity : Math.abs(this.cutOf(i, floor) - this.height) < 0.01;
      button.setAttribute('aria-pressed', String(isOn));
    });
    this.host.dataset['paused'] = String(this.isPaused);
    this.onChange();
  }
}
