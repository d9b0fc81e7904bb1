// SPDX-License-Identifier: MIT
// The colours that the page's style gives to the view: they follow the theme.

import { rgbOf } from './tubes.js';
import type { Rgb } from './tubes.js';

export interface Theme {
  back: Rgb;
  surface: Rgb;
  cut: Rgb;
  edge: Rgb;
  edgeOpacity: number;
  ink: Rgb;
  rim: Rgb;
  accent: Rgb;
  object: Rgb;
}

export function readTheme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const text = (name: string): string => style.getPropertyValue(name).trim();
  const colour = (name: string): Rgb => rgbOf(text(name) || '#808080');
  return {
    back: colour('--view-back'),
    surface: colour('--view-surface'),
    cut: colour('--view-cut'),
    edge: colour('--view-edge'),
    edgeOpacity: Number(text('--view-edge-opacity')) || 0.5,
    ink: colour('--view-ink'),
    rim: colour('--view-rim'),
    accent: colour('--view-accent'),
    object: colour('--view-object'),
  };
}
