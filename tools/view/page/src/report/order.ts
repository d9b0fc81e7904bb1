// SPDX-License-Identifier: MIT
// The order of the rows of a report.

/** A cell is sorted by its number, if it has one, or by its text. */
export interface Cell {
  text: string;
  number: number | undefined;
}

/** Compares two cells of a column: numbers by their size, all else as text. */
export function compareCells(a: Cell, b: Cell): number {
  if (a.number !== undefined && b.number !== undefined) return a.number - b.number;
  return a.text.localeCompare(b.text);
}

function cellOf(row: HTMLTableRowElement, column: number): Cell {
  const cell = row.cells[column];
  const number = cell?.dataset['v'];
  return { text: cell?.textContent ?? '', number: number === undefined ? undefined : Number(number) };
}

/** Has a click on a head of the table sort it by that column, up and then down. */
export function makeSortable(table: HTMLTableElement): void {
  const heads = [...(table.tHead?.rows[0]?.cells ?? [])];
  const body = table.tBodies[0];
  if (!body) return;
  for (const head of heads) {
    head.dataset['sorts'] = '';
    head.addEventListener('click', () => {
      const isUp = head.getAttribute('aria-sort') !== 'ascending';
      for (const other of heads) other.removeAttribute('aria-sort');
      head.setAttribute('aria-sort', isUp ? 'ascending' : 'descending');
      const rows = [...body.rows].map((row) => ({ row, cell: cellOf(row, head.cellIndex) }));
      rows.sort((a, b) => (isUp ? compareCells(a.cell, b.cell) : compareCells(b.cell, a.cell)));
      body.append(...rows.map(({ row }) => row));
    });
  }
}
