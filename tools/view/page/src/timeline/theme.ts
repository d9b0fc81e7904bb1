// SPDX-License-Identifier: MIT

/** Colours that differ between the themes; those of meaning are in palette.ts. */
export interface Theme {
  text: string;
  muted: string;
  line: string;
  panel: string;
  accent: string;
  font: string;
}

const kFallback: Theme = {
  text: '#1a1a1a',
  muted: '#5c6166',
  line: '#d4d7da',
  panel: '#ffffff',
  accent: '#0b5cad',
  font: 'system-ui, sans-serif',
};

/** Reads the theme of an element from the variables of page.css. */
export function themeOf(element: HTMLElement): Theme {
  const style = getComputedStyle(element);
  const read = (name: keyof Theme): string => style.getPropertyValue(`--${name}`).trim() || kFallback[name];
  return {
    text: read('text'),
    muted: read('muted'),
    line: read('line'),
    panel: read('panel'),
    accent: read('accent'),
    font: style.fontFamily || read('font'),
  };
}

/** Calls `changed` when the page or the system changes the theme. */
export function watchTheme(changed: () => void): void {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
  const attributes = { attributes: true, attributeFilter: ['data-theme', 'class'] };
  new MutationObserver(changed).observe(document.documentElement, attributes);
  new MutationObserver(changed).observe(document.body, attributes);
}
