# SPDX-License-Identifier: MIT
"""Samples of formats with smooth surfaces, for sample_files.py."""

import math

from sample_registry import CORNERS, FACES, sample

@sample("smooth/patches.bpt")
def bezier():
    points = [(0.5 * i, 0.25 * j, 0.1 * i * (3 - i) * j) for j in range(7) for i in range(4)]
    patches = [[1 + 4 * j + i for j in range(first, first + 4) for i in range(4)] for first in (0, 3)]
    text = "2\n" + "".join(",".join(map(str, patch)) + "\n" for patch in patches)
    return text + f"{len(points)}\n" + "".join(",".join(map(str, p)) + "\n" for p in points)


@sample("cad/box.step")
def step():
    """A box of flat faces, as a product in millimetres."""
    rows = []

    def add(text):
        rows.append(f"#{len(rows) + 1}={text};")
        return f"#{len(rows)}"

    def vector(kind, *numbers):
        return add(f"{kind}('',({','.join(repr(float(n)) for n in numbers)}))")

    context = add("APPLICATION_CONTEXT('automotive design')")
    add("APPLICATION_PROTOCOL_DEFINITION('','automotive_design',2000," + context + ")")
    mechanics = add(f"PRODUCT_CONTEXT('',{context},'mechanical')")
    product = add(f"PRODUCT('box','box','',({mechanics}))")
    version = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    design = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{context},'design')")
    definition = add(f"PRODUCT_DEFINITION('','',{version},{design})")
    shape = add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    length = add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    error = add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),{length},'','')")
    space = add(f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({error}))"
                f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))")
    corners = [vector("CARTESIAN_POINT", *(1000 * x for x in corner)) for corner in CORNERS]
    faces = []
    for face in FACES:
        a, b, c = (CORNERS[i] for i in face[:3])
        along = [(q - p) / math.dist(a, b) for p, q in zip(a, b)]
        ahead = [q - p for p, q in zip(b, c)]
        normal = [along[1] * ahead[2] - along[2] * ahead[1], along[2] * ahead[0] - along[0] * ahead[2],
                  along[0] * ahead[1] - along[1] * ahead[0]]
        normal = [x / math.hypot(*normal) for x in normal]
        axes = [vector("DIRECTION", *normal), vector("DIRECTION", *along)]
        place = add(f"AXIS2_PLACEMENT_3D('',{corners[face[0]]},{axes[0]},{axes[1]})")
        plane = add(f"PLANE('',{place})")
        loop = add(f"POLY_LOOP('',({','.join(corners[i] for i in face)}))")
        bound = add(f"FACE_OUTER_BOUND('',{loop},.T.)")
        faces.append(add(f"FACE_SURFACE('',({bound}),{plane},.T.)"))
    shell = add(f"CLOSED_SHELL('',({','.join(faces)}))")
    brep = add(f"FACETED_BREP('box',{shell})")
    drawn = add(f"FACETED_BREP_SHAPE_REPRESENTATION('',({brep}),{space})")
    add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{drawn})")
    head = ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
            "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n")
    return head + "\n".join(rows) + "\nENDSEC;\nEND-ISO-10303-21;\n"


@sample("cad/surface.iges")
def iges():
    """A bicubic surface with weights, in metres."""
    knots = [0.0] * 4 + [1.0] * 4
    points = [(i, j, 0.2 * i * j) for j in range(4) for i in range(4)]
    weights = [1.0 + 0.1 * (i % 3) for i in range(16)]
    values = [128, 3, 3, 3, 3, 0, 0, 0, 0, 0, *knots, *knots, *weights,
              *(float(x) for point in points for x in point), 0.0, 1.0, 0.0, 1.0]
    parameters, row = [], ""
    for i, value in enumerate(values):
        word = f"{value}" + (";" if i + 1 == len(values) else ",")
        if len(row) + len(word) > 64:
            parameters.append(row)
            row = ""
        row += word
    parameters.append(row)
    header = ("1H,,1H;,4Hpart,1Hx,1Hx,1Hx,32,38,6,308,15,4Hpart,1.,6,1HM,1,0.01,"
              "15H20261126.000000,1E-06,10.,1Hx,1Hx,11,0,15H20261126.000000;")
    sections = [("S", ["a surface"]),
                ("G", [header[i:i + 72] for i in range(0, len(header), 72)]),
                ("D", ["".join(f"{x:>8}" for x in (128, 1, 0, 0, 0, 0, 0, 0, "00000000")),
                       "".join(f"{x:>8}" for x in (128, 0, 0, len(parameters), 0, "", "", "", 0))]),
                ("P", [f"{text:<64}{1:>8}" for text in parameters])]
    text = ""
    for letter, rows in sections:
        text += "".join(f"{r:<72}{letter}{i + 1:>7}\n" for i, r in enumerate(rows))
    ends = "".join(f"{letter}{len(rows):>7}" for letter, rows in sections)
    return text + f"{ends:<72}T{1:>7}\n"
