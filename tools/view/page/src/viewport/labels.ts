// SPDX-License-Identifier: MIT
// Names beside what they name: numbers of keyframes, and the name of the object under the mouse or selected.

import { Vector3 } from 'three';
import type { Part } from './camera_views.js';
import type { Camera } from 'three';

/** Beyond that many, numbers would cover the path. */
const kMostNumbers = 60;
const kLeastDistance_px = 16;

export interface Label {
  text: string;
  at: Vector3;
  kind: 'keyframe' | 'selected' | 'invalid' | 'object' | 'free';
}

export class Labels {
  private readonly elements: HTMLElement[] = [];
  private labels: Label[] = [];

  constructor(private readonly host: HTMLElement) {
    host.className = 'labels';
    host.setAttribute('aria-hidden', 'true');
  }

  show(labels: readonly Label[]): void {
    this.labels = labels.filter(({ kind }, i) => kind !== 'keyframe' || i < kMostNumbers);
    while (this.elements.length < this.labels.length) {
      const element = document.createElement('span');
      this.elements.push(element);
      this.host.append(element);
    }
    this.elements.forEach((element, i) => {
      const label = this.labels[i];
      element.hidden = !label;
      if (!label) return;
      element.textContent = label.text;
      element.dataset['kind'] = label.kind;
    });
  }

  /**
   * Moves the names to where their places are on the screen; of numbers that would overlap, one is shown. Parts of the
   * canvas that show something else are `covered`.
   */
  place(camera: Camera, width: number, height: number, isVisible: boolean, covered: readonly Part[]): void {
    const taken: [number, number][] = [];
    const projected = new Vector3();
    this.host.hidden = !isVisible;
    if (!isVisible) return;
    this.labels.forEach(({ at, kind }, i) => {
      const element = this.elements[i];
      if (!element) return;
      projected.copy(at).project(camera);
      const x = (projected.x * 0.5 + 0.5) * width;
      const y = (0.5 - projected.y * 0.5) * height;
      const isInside = Math.abs(projected.z) < 1 && x > 0 && x < width && y > 0 && y < height;
      const isCrowded = kind === 'keyframe' && taken.some(([u, v]) => Math.hypot(u - x, v - y) < kLeastDistance_px);
      const isCovered = covered.some((part) => x > part.x - 20 && x < part.x + part.width && height - y > part.y && height - y < part.y + part.height);
      element.hidden = !isInside || isCrowded || isCovered;
      if (element.hidden) return;
      taken.push([x, y]);
      element.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    });
  }
}
