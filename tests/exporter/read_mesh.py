"""Reads a mesh from binary PLY, OBJ, glTF or GLB and says what is in it, with nothing but Python itself:
the numbers of vertices and triangles, the area, the bounds, and, z up again, the volume that the triangles
enclose with the origin (its sign says which way they are wound)."""
import json
import os
import struct
import sys


def read_ply(data):
    head, body = data.split(b"end_header\n", 1)
    lines = [line.split() for line in head.decode().splitlines()]
    assert ["format", "binary_little_endian", "1.0"] in lines
    count = {line[1]: int(line[2]) for line in lines if line[0] == "element"}
    assert ["property", "float", "x"] in lines and ["property", "list", "uchar", "int", "vertex_index"] in lines
    assert sum(line[0] == "property" for line in lines) == 4, "more than x, y, z"
    vertices = list(struct.iter_unpack("<3f", body[:12 * count["vertex"]]))
    faces = list(struct.iter_unpack("<B3I", body[12 * count["vertex"]:]))
    assert len(faces) == count["face"] and all(face[0] == 3 for face in faces)
    return vertices, [face[1:] for face in faces]


def read_obj(data):
    lines = [line.split() for line in data.decode().splitlines()]
    vertices = [tuple(map(float, line[1:4])) for line in lines if line[:1] == ["v"]]
    faces = [tuple(int(w.split("/")[0]) - 1 for w in line[1:]) for line in lines if line[:1] == ["f"]]
    return vertices, faces


def read_gltf(document, buffer):
    assert document["asset"]["version"] == "2.0"

    def accessor(index, code, width):
        about = document["accessors"][index]
        view = document["bufferViews"][about["bufferView"]]
        start = view.get("byteOffset", 0) + about.get("byteOffset", 0)
        form = "<" + str(width) + code
        return list(struct.iter_unpack(form, buffer[start:start + about["count"] // (3 if code == "I" else 1)
                                                    * struct.calcsize(form)]))

    assert len(document["meshes"]) == 1 and len(document["meshes"][0]["primitives"]) == 1
    primitive = document["meshes"][0]["primitives"][0]
    assert primitive.get("mode", 4) == 4
    assert document["accessors"][primitive["indices"]]["componentType"] == 5125
    assert document["accessors"][primitive["attributes"]["POSITION"]]["componentType"] == 5126
    nodes = document["nodes"]
    assert all("matrix" not in node and "rotation" not in node for node in nodes)
    vertices = accessor(primitive["attributes"]["POSITION"], "f", 3)
    # glTF is y up; back to z up.
    return [(x, -z, y) for x, y, z in vertices], accessor(primitive["indices"], "I", 3)


def read_glb(data):
    magic, version, length = struct.unpack_from("<4sII", data)
    assert magic == b"glTF" and version == 2 and length == len(data)
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    document = json.loads(data[20:20 + size])
    binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    return read_gltf(document, data[28 + size:28 + size + binary_size])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


path = sys.argv[1]
with open(path, "rb") as file:
    data = file.read()
if path.endswith(".ply"):
    vertices, faces = read_ply(data)
elif path.endswith(".obj"):
    vertices, faces = read_obj(data)
elif path.endswith(".glb"):
    vertices, faces = read_glb(data)
else:
    document = json.loads(data)
    with open(os.path.join(os.path.dirname(path), document["buffers"][0]["uri"]), "rb") as file:
        vertices, faces = read_gltf(document, file.read())
area = volume = 0.0
for face in faces:
    a, b, c = (vertices[i] for i in face)
    normal = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
    area += 0.5 * dot(normal, normal) ** 0.5
    volume += dot(a, cross(b, c)) / 6.0
print("vertices", len(vertices))
print("triangles", len(faces))
print("area", area)
print("volume", volume)
print("min", *(min(v[k] for v in vertices) for k in range(3)))
print("max", *(max(v[k] for v in vertices) for k in range(3)))
