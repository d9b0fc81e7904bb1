# SPDX-License-Identifier: MIT
"""A small writer of SVG figures: boxes, arrows, curves and text, in a light and a dark theme."""

from html import escape

STYLE = """
  text { font: 13px sans-serif; fill: #1f2328; }
  .small { font-size: 11px; fill: #59636e; }
  .title { font-weight: 600; }
  .box { fill: #f6f8fa; stroke: #8c959f; }
  .accent { fill: #ddf4ff; stroke: #0969da; }
  .warm { fill: #fff1e5; stroke: #bc4c00; }
  .line { fill: none; stroke: #59636e; stroke-width: 1.4; }
  .path { fill: none; stroke: #0969da; stroke-width: 2.4; }
  .scene { fill: #d0d7de; stroke: #57606a; }
  .ghost { fill: none; stroke: #8c959f; stroke-dasharray: 4 3; }
  .head { fill: #59636e; }
  @media (prefers-color-scheme: dark) {
    text { fill: #e6edf3; }
    .small { fill: #9198a1; }
    .box { fill: #212830; stroke: #656c76; }
    .accent { fill: #12263f; stroke: #4493f8; }
    .warm { fill: #3a1f10; stroke: #f0883e; }
    .line { stroke: #9198a1; }
    .path { stroke: #4493f8; }
    .scene { fill: #3d444d; stroke: #9198a1; }
    .ghost { stroke: #656c76; }
    .head { fill: #9198a1; }
  }
"""


class Figure:
    """Collects elements in pixels, origin at the top left; `text()` returns the finished file."""

    def __init__(self, width, height, title):
        self._size = (width, height)
        self._title = title
        self._elements = []

    def add(self, element):
        self._elements.append(element)

    def text(self, x, y, words, style="", anchor="middle"):
        self.add(f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" class="{style}">{escape(words)}</text>')

    def box(self, x, y, width, height, lines, style="box"):
        """A rounded box; the first line is its title, the others are small."""
        self.add(f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="5" class="{style}"/>')
        top = y + height / 2 - 8 * (len(lines) - 1) + 4
        for i, words in enumerate(lines):
            self.text(x + width / 2, top + 16 * i, words, "title" if i == 0 else "small")

    def arrow(self, points, words="", style="line"):
        """A polyline with a head at its last point and words above its middle."""
        route = " ".join(f"{x:g},{y:g}" for x, y in points)
        self.add(f'<polyline points="{route}" class="{style}" marker-end="url(#head)"/>')
        if words:
            (x0, y0), (x1, y1) = points[len(points) // 2 - 1], points[len(points) // 2]
            self.text((x0 + x1) / 2, (y0 + y1) / 2 - 5, words, "small")

    def curve(self, data, style):
        self.add(f'<path d="{data}" class="{style}"/>')

    def polygon(self, points, style):
        self.add(f'<polygon points="{" ".join(f"{x:g},{y:g}" for x, y in points)}" class="{style}"/>')

    def file(self):
        width, height = self._size
        body = "\n".join("  " + e for e in self._elements)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
                f'width="{width}" height="{height}" role="img" aria-label="{escape(self._title)}">\n'
                f"  <title>{escape(self._title)}</title>\n  <style>{STYLE}  </style>\n"
                '  <defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
                'orient="auto"><path d="M0,0 L8,4 L0,8 z" class="head"/></marker></defs>\n'
                f"{body}\n</svg>\n")
