# SPDX-License-Identifier: MIT
"""What the sample files of all formats share: their list, and the shapes in them."""

# Names of files -> functions that return their bytes, or several files: the first is read, the
# others are beside it.
SAMPLES = {}


def sample(name):
    def keep(function):
        SAMPLES[name] = function
        return function

    return keep


# A box: eight corners, and its faces from outside.
CORNERS = [(x, y, z) for z in (0.5, 2.0) for y in (-0.25, 1.0) for x in (0.0, 1.5)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [t for f in FACES for t in ((f[0], f[1], f[2]), (f[0], f[2], f[3]))]
POINTS = [(0.1 * i, 0.1 * (i % 4), 0.07 * (i % 5)) for i in range(40)]


def lines(rows):
    return "\n".join(" ".join(str(x) for x in row) for row in rows) + "\n"
