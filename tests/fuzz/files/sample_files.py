#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a small valid file of each format that Camway reads, for hostile_files.py.

  tests/fuzz/files/sample_files.py FOLDER

A format joins by a function that is marked with @sample, here or in sample_surfaces.py and
sample_cameras.py, or by a file in a folder that hostile_files.py is given with --samples. Standard
library only.
"""

import json
import struct
import sys
import zlib
from pathlib import Path

import sample_cameras  # noqa: F401  adds its samples
import sample_surfaces  # noqa: F401
from sample_registry import CORNERS, FACES, POINTS, SAMPLES, TRIANGLES, lines, sample


@sample("box.obj")
def obj():
    text = "o box\n" + lines(("v", *c) for c in CORNERS)
    text += lines(("f", *(i + 1 for i in f)) for f in FACES)
    return text + "v 1 2 3 0.5\nf -1 1//1 2/2\nl 1 2\np 3\ng a b\ns off\nf 1 2 \\\n3 4\n"


@sample("box.off")
def off():
    return "OFF\n8 6 0\n" + lines(CORNERS) + lines((4, *f) for f in FACES)


def ply_header(kind):
    return (f"ply\nformat {kind} 1.0\ncomment a box\nelement vertex 8\nproperty float x\n"
            "property double y\nproperty float z\nproperty uchar red\nelement face 6\n"
            "property list uchar int vertex_indices\nend_header\n")


@sample("text.ply")
def ply_text():
    return ply_header("ascii") + lines((*c, 7) for c in CORNERS) + lines((4, *f) for f in FACES)


@sample("little.ply")
def ply_little():
    data = b"".join(struct.pack("<fdfB", *c, 7) for c in CORNERS)
    data += b"".join(struct.pack("<B4i", 4, *f) for f in FACES)
    return ply_header("binary_little_endian").encode() + data


@sample("big.ply")
def ply_big():
    data = b"".join(struct.pack(">fdfB", *c, 7) for c in CORNERS)
    data += b"".join(struct.pack(">B4i", 4, *f) for f in FACES)
    return ply_header("binary_big_endian").encode() + data


@sample("text.stl")
def stl_text():
    text = "solid box\n"
    for t in TRIANGLES:
        text += "facet normal 0 0 1\nouter loop\n"
        text += lines(("vertex", *CORNERS[i]) for i in t) + "endloop\nendfacet\n"
    return text + "endsolid box\n"


@sample("binary.stl")
def stl_binary():
    data = b"box".ljust(80, b" ") + struct.pack("<I", len(TRIANGLES))
    for t in TRIANGLES:
        data += struct.pack("<12fH", 0, 0, 1, *(x for i in t for x in CORNERS[i]), 0)
    return data


@sample("boxes.ug")
def unigrafix():
    text = "def box;\n" + "".join(f"v c{i} {x} {y} {z};\n" for i, (x, y, z) in enumerate(CORNERS))
    for face in FACES:
        text += "f (" + " ".join(f"c{i}" for i in face) + ") red;\n"
    return text + "end;\ni a (box -tx 2 -ry 30);\na b (box) 3 -tz 2;\nc red 1 2 3;\n{ a remark }\n"


@sample("shapes.iv")
def inventor():
    points = ", ".join("%g %g %g" % c for c in CORNERS)
    faces = ", ".join("%d, %d, %d, %d, -1" % f for f in FACES)
    return ("#Inventor V2.1 ascii\n\nSeparator {\n  Units { units METERS }\n  DEF A Separator {\n"
            "    Transform { translation 1 2 3 rotation 0 1 0 0.5 }\n"
            f"    Coordinate3 {{ point [ {points} ] }}\n"
            f"    IndexedFaceSet {{ coordIndex [ {faces} ] }}\n  }}\n"
            "  Sphere { radius 0.5 }\n  Cone { bottomRadius 1 height 2 }\n"
            "  Coordinate4 { point [ 0 0 0 1, 1 0 0 1, 0 1 0 1, 1 1 1 1 ] }\n"
            "  NurbsSurface { numUControlPoints 2 numVControlPoints 2\n"
            "    uKnotVector [ 0, 0, 1, 1 ] vKnotVector [ 0, 0, 1, 1 ] }\n"
            "  Switch { whichChild 0 USE A Cube { } }\n}\n")


@sample("shapes.wrl")
def vrml():
    points = ", ".join("%g %g %g" % c for c in CORNERS)
    faces = ", ".join("%d, %d, %d, %d, -1" % f for f in FACES)
    return ("#VRML V2.0 utf8\nDEF A Transform { translation 1 2 3 children [ Shape {\n"
            f"  geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }}\n"
            f"    coordIndex [ {faces} ] }} }} ] }}\n"
            "Shape { geometry Sphere { radius 0.5 } }\nShape { geometry Box { size 1 2 3 } }\n"
            "Shape { geometry ElevationGrid { xDimension 2 zDimension 2 height [ 0 1 2 3 ] } }\n"
            "Shape { geometry Extrusion { crossSection [ 0 0, 1 0, 1 1, 0 0 ] "
            "spine [ 0 0 0, 0 1 0 ] } }\nUSE A\n")


@sample("shapes.iv.gz")
def inventor_gzip():
    packer = zlib.compressobj(9, zlib.DEFLATED, 31)
    return packer.compress(inventor().encode()) + packer.flush()


@sample("box.dae")
def collada():
    floats = " ".join("%g %g %g" % c for c in CORNERS)
    faces = " ".join(str(i) for f in FACES for i in f)
    keys = " ".join(f"1 0 0 {i} 0 1 0 2 0 0 1 {i * i} 0 0 0 1" for i in range(3))

    def source(name, values, stride, kind="float"):
        count = len(values.split())
        tag = "Name" if kind == "Name" else "float"
        return (f'<source id="{name}"><{tag}_array id="{name}a" count="{count}">{values}'
                f'</{tag}_array><technique_common><accessor source="#{name}a" '
                f'count="{count // stride}" stride="{stride}"><param name="X" type="{kind}"/>'
                "</accessor></technique_common></source>")

    animation = source("t", "0 1 2", 1) + source("k", keys, 16, "float4x4")
    animation += source("i", "LINEAR LINEAR LINEAR", 1, "Name")
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="meter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
 <library_cameras><camera id="c"><optics><technique_common><perspective><yfov>40</yfov>
  <aspect_ratio>1.5</aspect_ratio><znear>0.1</znear><zfar>9</zfar></perspective>
  </technique_common></optics></camera></library_cameras>
 <library_geometries><geometry id="g" name="g"><mesh>
  <source id="p"><float_array id="a" count="24">{floats}</float_array><technique_common>
   <accessor source="#a" count="8" stride="3"><param name="X" type="float"/>
   <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
  </source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/>
   <vcount>4 4 4 4 4 4</vcount><p>{faces}</p></polylist></mesh></geometry></library_geometries>
 <library_animations><animation>{animation}<sampler id="sa"><input semantic="INPUT" source="#t"/>
  <input semantic="OUTPUT" source="#k"/><input semantic="INTERPOLATION" source="#i"/></sampler>
  <channel source="#sa" target="m/transform"/></animation></library_animations>
 <library_visual_scenes><visual_scene id="s"><node id="n"><matrix>1 0 0 2 0 1 0 3 0 0 1 4 0 0 0 1
  </matrix><instance_geometry url="#g"/><node id="m"><matrix sid="transform">1 0 0 0 0 1 0 2 0 0 1 0 0 0 0 1</matrix>
  <instance_camera url="#c"/></node></node></visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""


def gltf_parts():
    """The buffer and the description of a box with a camera that moves."""
    buffer = b"".join(struct.pack("<3f", *c) for c in CORNERS)
    buffer += b"".join(struct.pack("<3H", *t) for t in TRIANGLES)
    buffer += struct.pack("<3f", 0, 1, 2)
    buffer += b"".join(struct.pack("<3f", i, 0, 5) for i in range(3))
    ends = [0, 96, 168, 180, 216]
    views = [{"buffer": 0, "byteOffset": a, "byteLength": b - a} for a, b in zip(ends, ends[1:])]
    return buffer, {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "box", "scale": [1, 2, 1]},
                  {"camera": 0, "name": "cam", "translation": [0, 0, 5]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                        "samplers": [{"input": 2, "output": 3}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
             "min": [0, -0.25, 0.5], "max": [1.5, 1, 2]},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0],
             "max": [2]},
            {"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": views, "buffers": [{"byteLength": len(buffer)}]}


@sample("box.gltf")
def gltf():
    buffer, description = gltf_parts()
    description["buffers"][0]["uri"] = "box.buffer"
    return [json.dumps(description, indent=1), ("box.buffer", buffer)]


@sample("box.glb")
def glb():
    buffer, description = gltf_parts()
    text = json.dumps(description).encode()
    text += b" " * (-len(text) % 4)
    buffer += bytes(-len(buffer) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text
    body += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


# The nodes of an FBX file: name, properties, children.
def fbx_nodes():
    vertices = [100.0 * x for c in CORNERS for x in c]
    faces = [i if k < 3 else -i - 1 for f in FACES for k, i in enumerate(f)]
    return [
        ("FBXHeaderExtension", [], [("FBXHeaderVersion", [1003], []), ("FBXVersion", [7400], [])]),
        ("GlobalSettings", [], [("Version", [1000], []), ("Properties70", [], [
            ("P", ["UpAxis", "int", "Integer", "", 1], []),
            ("P", ["UnitScaleFactor", "double", "Number", "", 1.0], [])])]),
        ("Objects", [], [
            ("Geometry", [1000, "Geometry::box", "Mesh"], [
                ("Vertices", [vertices], []), ("PolygonVertexIndex", [faces], []),
                ("GeometryVersion", [124], [])]),
            ("Model", [2000, "Model::box", "Mesh"], [
                ("Version", [232], []), ("Properties70", [], [
                    ("P", ["Lcl Translation", "Lcl Translation", "", "A", 1.0, 2.0, 3.0], [])])])]),
        ("Connections", [], [("C", ["OO", 2000, 0], []), ("C", ["OO", 1000, 2000], [])])]


@sample("text.fbx")
def fbx_text():
    def write(node, indent):
        name, properties, children = node
        text = f"{indent}{name}: "
        if properties and isinstance(properties[0], list):
            numbers = ",".join("%g" % x for x in properties[0])
            return text + f"*{len(properties[0])} {{\n{indent}\ta: {numbers}\n{indent}}}\n"
        text += ", ".join(f'"{p}"' if isinstance(p, str) else str(p) for p in properties)
        if children or not properties:
            inner = "".join(write(child, indent + "\t") for child in children)
            text += f" {{\n{inner}{indent}}}"
        return text + "\n"

    return "; FBX 7.4.0 project file\n\n" + "".join(write(node, "") for node in fbx_nodes())


@sample("binary.fbx")
def fbx_binary():
    def property_bytes(value, is_object):
        if isinstance(value, list):
            kind, code = (b"d", "d") if isinstance(value[0], float) else (b"i", "i")
            packed = zlib.compress(struct.pack(f"<{len(value)}{code}", *value))
            return kind + struct.pack("<III", len(value), 1, len(packed)) + packed
        if isinstance(value, str):
            # In binary files, the class follows the name.
            name = "\0\1".join(reversed(value.split("::"))).encode()
            return b"S" + struct.pack("<I", len(name)) + name
        if isinstance(value, float):
            return b"D" + struct.pack("<d", value)
        return b"L" + struct.pack("<q", value) if is_object else b"I" + struct.pack("<i", value)

    def write(node, at):
        name, properties, children = node
        is_object = name in ("Geometry", "Model", "C")
        data = b"".join(property_bytes(p, is_object) for p in properties)
        head = 13 + len(name)
        body = b""
        for child in children:
            body += write(child, at + head + len(data) + len(body))
        if children:
            body += bytes(13)
        end = at + head + len(data) + len(body)
        return struct.pack("<IIIB", end, len(properties), len(data),
                           len(name)) + name.encode() + data + body

    file = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400)
    for node in fbx_nodes():
        file += write(node, len(file))
    return file + bytes(13) + bytes(160)


@sample("box.3ds")
def three_ds():
    def chunk(code, data):
        return struct.pack("<HI", code, 6 + len(data)) + data

    points = struct.pack("<H", 8) + b"".join(struct.pack("<3f", *c) for c in CORNERS)
    faces = struct.pack("<H", 12) + b"".join(struct.pack("<4H", *t, 7) for t in TRIANGLES)
    matrix = struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)
    mesh = chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces) + chunk(0x4160, matrix))
    key = chunk(0xB010, b"box\0" + struct.pack("<HHh", 0, 0, -1))
    key += chunk(0xB013, struct.pack("<3f", 0, 0, 0))
    frames = chunk(0xB000, chunk(0xB008, struct.pack("<II", 0, 9)) + chunk(0xB002, key))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)) + chunk(
        0x3D3D, chunk(0x4000, b"box\0" + mesh)) + frames)


@sample("wall.ifc")
def ifc():
    return """ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('ViewDefinition'),'2;1');
FILE_NAME('wall','2026-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('IFC2X3'));
ENDSEC;
DATA;
#1=IFCPERSON($,'P',$,$,$,$,$,$);
#2=IFCORGANIZATION($,'O',$,$,$);
#3=IFCPERSONANDORGANIZATION(#1,#2,$);
#4=IFCAPPLICATION(#2,'1','A','A');
#5=IFCOWNERHISTORY(#3,#4,$,.ADDED.,$,$,$,0);
#6=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);
#7=IFCUNITASSIGNMENT((#6));
#8=IFCCARTESIANPOINT((0.,0.,0.));
#9=IFCDIRECTION((0.,0.,1.));
#10=IFCDIRECTION((1.,0.,0.));
#11=IFCAXIS2PLACEMENT3D(#8,#9,#10);
#12=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#11,$);
#13=IFCPROJECT('0aaaaaaaaaaaaaaaaaaaaa',#5,'P',$,$,$,$,(#12),#7);
#14=IFCLOCALPLACEMENT($,#11);
#15=IFCSITE('0aaaaaaaaaaaaaaaaaaaab',#5,'S',$,$,#14,$,$,.ELEMENT.,$,$,$,$,$);
#16=IFCRELAGGREGATES('0aaaaaaaaaaaaaaaaaaaac',#5,$,$,#13,(#15));
#17=IFCCARTESIANPOINT((0.,0.));
#18=IFCDIRECTION((1.,0.));
#19=IFCAXIS2PLACEMENT2D(#17,#18);
#20=IFCRECTANGLEPROFILEDEF(.AREA.,$,#19,4.,0.3);
#21=IFCEXTRUDEDAREASOLID(#20,#11,#9,2.5);
#22=IFCSHAPEREPRESENTATION(#12,'Body','SweptSolid',(#21));
#23=IFCPRODUCTDEFINITIONSHAPE($,$,(#22));
#24=IFCWALL('0aaaaaaaaaaaaaaaaaaaad',#5,'W',$,$,#14,#23,$);
#25=IFCRELCONTAINEDINSPATIALSTRUCTURE('0aaaaaaaaaaaaaaaaaaaae',#5,$,$,(#24),#15);
ENDSEC;
END-ISO-10303-21;
"""


MAP_DEPTH = 16  # of OctoMap's trees


def octree(depth):
    """The nodes of a tree of OctoMap whose leaves, at `depth`, are near the origin."""
    if depth == 0:
        return None
    octants = (7,) if depth == MAP_DEPTH else (0,) if depth > 3 else (0, 7 if depth % 2 else 3)
    return {octant: octree(depth - 1) for octant in octants}


@sample("map.ot")
def map_full():
    def write(node):
        if node is None:
            return struct.pack("<fB", 1.0, 0), 1
        data, count = struct.pack("<fB", 1.0, sum(1 << i for i in node)), 1
        for child in node.values():
            more, number = write(child)
            data, count = data + more, count + number
        return data, count

    data, count = write(octree(MAP_DEPTH))
    head = f"# Octomap OcTree file\n# a remark\nid OcTree\nsize {count}\nres 0.1\ndata\n"
    return head.encode() + data


@sample("map.bt")
def map_binary():
    def write(node):
        # Two bits for a child: 1 free, 2 occupied, 3 with children of its own.
        codes = {octant: 2 if child is None else 3 for octant, child in node.items()}
        if None in node.values():
            codes.setdefault(1, 1)
        data = struct.pack("<H", sum(code << 2 * octant for octant, code in codes.items()))
        count = 1 + len([c for c in codes.values() if c != 3])
        for child in node.values():
            if child is not None:
                more, number = write(child)
                data, count = data + more, count + number
        return data, count

    data, count = write(octree(MAP_DEPTH))
    head = f"# Octomap OcTree binary file\nid OcTree\nsize {count}\nres 0.1\ndata\n"
    return head.encode() + data


def pcd_header(kind):
    return ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb normal\n"
            "SIZE 4 4 8 4 2\nTYPE F F F U I\nCOUNT 1 1 1 1 3\nWIDTH 40\nHEIGHT 1\n"
            f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 40\nDATA {kind}\n")


@sample("text.pcd")
def pcd_text():
    return pcd_header("ascii") + lines((*p, 255, 1, 2, 3) for p in POINTS)


@sample("binary.pcd")
def pcd_binary():
    return pcd_header("binary").encode() + b"".join(
        struct.pack("<ffdI3h", *p, 255, 1, 2, 3) for p in POINTS)


def lzf(data):
    """LZF of literals, and of a reference where bytes repeat those of eight bytes ago."""
    packed, at = b"", 0
    while at < len(data):
        length = 0
        while at >= 8 and at + length < len(data) and length < 8 and (
                data[at + length] == data[at - 8 + length]):
            length += 1
        if length >= 3:
            packed += bytes([(length - 2) << 5, 7])
            at += length
        else:
            part = data[at:at + 4]
            packed += bytes([len(part) - 1]) + part
            at += len(part)
    return packed


@sample("compressed.pcd")
def pcd_compressed():
    columns = [[p[0] for p in POINTS], [p[1] for p in POINTS], [p[2] for p in POINTS]]
    data = struct.pack("<40f", *columns[0]) + struct.pack("<40f", *columns[1])
    data += struct.pack("<40d", *columns[2]) + struct.pack("<40I", *[255] * 40)
    data += struct.pack("<120h", *[1, 2, 3] * 40)
    packed = lzf(data)
    return pcd_header("binary_compressed").encode() + struct.pack(
        "<II", len(packed), len(data)) + packed


@sample("points.xyz")
def xyz():
    return "# a remark\nx y z intensity\n" + lines((*p, 0.5) for p in POINTS)


def las_bytes(minor, header_bytes, kind, record_bytes):
    header = bytearray(header_bytes)
    header[0:4] = b"LASF"
    struct.pack_into("<BB", header, 24, 1, minor)
    struct.pack_into("<HIIBHI", header, 94, header_bytes, header_bytes, 0, kind, record_bytes,
                     0 if minor == 4 else len(POINTS))
    struct.pack_into("<6d", header, 131, 0.001, 0.001, 0.001, 635000.0, 848000.0, 400.0)
    if minor == 4:
        struct.pack_into("<Q", header, 247, len(POINTS))
    data = bytes(header)
    for point in POINTS:
        data += struct.pack("<3i", *(round(1000 * x) for x in point)).ljust(record_bytes, b"\1")
    return data


@sample("old.las")
def las_old():
    return las_bytes(2, 227, 3, 34)


@sample("new.las")
def las_new():
    return las_bytes(4, 375, 7, 36)


@sample("room.voxel.json")
def splat_voxels():
    # The root has two children: a cube that is solid, and one with a leaf of single voxels.
    nodes = [(0b10000001 << 24) | 1, 0xFF000000, (0b1 << 24) | 3, 0]
    leaf = [0x0F0F0F0F, 0x12345678]
    description = {"version": "1.1", "gridBounds": {"min": [-1.6, -0.4, 0.05],
                                                    "max": [0.0, 1.2, 1.65]},
                   "voxelResolution": 0.1, "leafSize": 4, "treeDepth": 2, "numInteriorNodes": 2,
                   "numMixedLeaves": 1, "nodeCount": 4, "leafDataCount": 2}
    return [json.dumps(description, indent=1), ("room.voxel.bin", struct.pack("<6I", *nodes, *leaf))]


# Cameras in scene files.


@sample("cameras/box.gltf")
def camera_gltf():
    return gltf()


@sample("cameras/box.glb")
def camera_glb():
    return glb()


@sample("cameras/box.dae")
def camera_collada():
    return collada()


def as_bytes(content):
    return content.encode() if isinstance(content, str) else content


def write_all(folder):
    """Writes the files. Returns the paths of those that are read, without their companions."""
    paths = []
    for name, function in SAMPLES.items():
        path = Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        made = function()
        content, companions = (made[0], made[1:]) if isinstance(made, list) else (made, [])
        path.write_bytes(as_bytes(content))
        for other, data in companions:
            (path.parent / other).write_bytes(as_bytes(data))
        paths.append(path)
    return paths


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for written in write_all(sys.argv[1]):
        print(written)
