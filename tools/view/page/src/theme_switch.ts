// SPDX-License-Identifier: MIT
// Dark or light: as the system has it, or as the person chose for this page.

const kStored = 'camway-theme';
const kDark = matchMedia('(prefers-color-scheme: dark)');

function stored(): string | null {
  try {
    return localStorage.getItem(kStored);
  } catch {
    return null; // a file that is opened from the disk may have no storage
  }
}

function isDarkNow(): boolean {
  const chosen = document.documentElement.dataset['theme'];
  return chosen === undefined ? kDark.matches : chosen === 'dark';
}

export function switchTheme(): void {
  const theme = isDarkNow() ? 'light' : 'dark';
  document.documentElement.dataset['theme'] = theme;
  try {
    localStorage.setItem(kStored, theme);
  } catch {
    // The choice holds until the page is closed.
  }
}

/** Takes the stored choice, and calls `changed` on each change of the theme. */
export function watchTheme(changed: () => void): void {
  const theme = stored();
  if (theme === 'dark' || theme === 'light') document.documentElement.dataset['theme'] = theme;
  kDark.addEventListener('change', changed);
  new MutationObserver(changed).observe(document.documentElement, { attributes: true, attributeFilter: ['data-theme'] });
}
