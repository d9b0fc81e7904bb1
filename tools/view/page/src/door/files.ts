// SPDX-License-Identifier: MIT
// Files of the person at the browser.

/** Offers a file for saving. */
export function saveFile(name: string, content: Blob | string, type = 'application/json'): void {
  const blob = typeof content === 'string' ? new Blob([content], { type }) : content;
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The field whose dialog is open: browsers forget the choice of a field that nothing else holds, as soon as they tidy up. */
let picker: HTMLInputElement | undefined;

/** Asks for a file; resolves with its text, and never if none is chosen. */
export function pickFile(accept: string): Promise<{ name: string; text: string }> {
  return new Promise((done) => {
    const input = document.createElement('input');
    picker = input;
    input.type = 'file';
    input.accept = accept;
    input.addEventListener('change', () => {
      const file = input.files?.[0];
      if (picker === input) picker = undefined;
      if (file) void file.text().then((text) => done({ name: file.name, text }));
    });
    input.click();
  });
}
