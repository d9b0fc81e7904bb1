// SPDX-License-Identifier: MIT
// Keyframes: given ones as discs in the colour of text, inserted ones as green diamonds, invalid ones as crosses in
// vermillion with the nearest free pose as a dashed ghost; each with a small pyramid that shows where it looks.

import { Group, Vector3 } from 'three';
import type { Answer } from '../contract/answer.js';
import type { PlanRequest } from '../contract/request.js';
import { kPalette } from '../model/palette.js';
import { addPyramid, kDefaultCamera, pyramidLength } from './bodies.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { Markers } from './markers.js';
import type { Marker } from './markers.js';
import { rgbOf, TubeBuilder, Tubes } from './tubes.js';
import type { Rgb, TubeUniforms } from './tubes.js';

/** Beyond that many keyframes, pyramids are drawn for the selected and the invalid ones alone. */
const kMostPyramids = 120;
const kGiven_px = 11;
const kSelected_px = 16;
const kInserted_px = 12;

export interface KeyframeLook {
  given: Rgb;
  selected: Rgb;
  rim: Rgb;
  pixelRatio: number;
}

export interface KeyframeScene {
  request: PlanRequest | undefined;
  answer: Answer | undefined;
  selected: number | undefined;
  frame: Frame;
  pathSize_m: number;
}

export class KeyframesView {
  readonly group = new Group();
  private readonly pyramids: Tubes;
  private readonly markers = new Markers(60);
  /** Places of the keyframes of the request, for picking and labels. */
  places: Vector3[] = [];

  constructor(shared: TubeUniforms) {
    this.pyramids = new Tubes(shared, 30);
    this.group.add(this.pyramids, this.markers);
  }

  show({ request, answer, selected, frame, pathSize_m }: KeyframeScene, look: KeyframeLook): void {
    const tubes = new TubeBuilder();
    const markers: Marker[] = [];
    const keyframes = request?.keyframes ?? [];
    const camera = request?.camera ?? kDefaultCamera;
    const length_m = pyramidLength(camera, pathSize_m);
    const invalid = rgbOf(kPalette.collision);
    const faults = new Map((answer?.keyframe_faults ?? []).map((fault) => [fault.keyframe, fault]));
    const special = specialKeyframes(answer);
    this.places = keyframes.map(({ position }) => frame.toLocal(position));
    keyframes.forEach((keyframe, i) => {
      const place = this.places[i] as Vector3;
      const isSelected = i === selected;
      const fault = faults.get(i);
      const isInvalid = fault !== undefined || special.shutIn === i;
      const proof = special.infeasible.has(i) ? rgbOf(kPalette.infeasible) : undefined;
      const colour = isInvalid ? invalid : (proof ?? (isSelected ? look.selected : look.given));
      markers.push({
        position: place,
        colour,
        shape: isInvalid ? 'cross' : 'disc',
        size_px: isSelected || isInvalid ? kSelected_px : kGiven_px,
      });
      if (isSelected) markers.push({ position: place, colour: look.selected, shape: 'ring', size_px: kSelected_px + 10 });
      if (proof) markers.push({ position: place, colour: proof, shape: 'ring', size_px: kSelected_px + 4 });
      if (keyframes.length > kMostPyramids && !isSelected && !isInvalid) return;
      const style = { radius_m: 0, least_px: isSelected ? 2.2 : 1.4 };
      addPyramid(tubes, camera, place, toQuaternion(keyframe.orientation), length_m, colour, style);
      const free = fault?.free_pose;
      if (!free) return;
      const ghost = frame.toLocal(free.position);
      const green = rgbOf(kPalette.inserted);
      addPyramid(tubes, camera, ghost, toQuaternion(free.orientation), length_m, green, { ...style, isDashed: true });
      tubes.segment(place, ghost, green, { radius_m: 0, least_px: 1.6, isDashed: true });
      markers.push({ position: ghost, colour: green, shape: 'ring', size_px: kGiven_px + 3 });
    });
    for (const keyframe of answer?.keyframes ?? []) {
      if (keyframe.origin !== 'inserted') continue;
      const place = frame.toLocal(keyframe.position);
      markers.push({ position: place, colour: rgbOf(kPalette.inserted), shape: 'diamond', size_px: kInserted_px });
    }
    this.markers.setLook(look.rim, look.pixelRatio);
    this.markers.show(markers);
    this.pyramids.show(tubes);
  }
}

function specialKeyframes(answer: Answer | undefined): { shutIn: number | undefined; infeasible: Set<number> } {
  const proof = answer?.infeasibility;
  return {
    shutIn: answer?.keyframe,
    infeasible: new Set(proof ? [proof.keyframe_inside, proof.keyframe_outside] : []),
  };
}
