"""Run by Blender: compares a baked glTF's vertex colours with the table of the same run.

blender --background --python-exit-code 1 --python blender.py -- BAKE.glb TABLE.csv

The bake is of the patch mesh, flat and unlit, so that every face has its patch's radiosity, exposed
and clamped to 1. Blender 3 keeps vertex colours as sRGB bytes: a level is what they may differ by.
"""
import csv
import json
import random
import sys

import bpy
import numpy

# Debian 12's Blender 3.4 uses a name that its NumPy 1.24 no longer has.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

bake, table = sys.argv[sys.argv.index("--") + 1:]
with open(bake, "rb") as glb:
    head = glb.read(20)
    extras = json.loads(glb.read(int.from_bytes(head[12:16], "little")))["asset"]["extras"]
assert extras["quantity"] == "radiosity" and extras["clamped"]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=bake)

# Blender turns glTF's y up into its own z up: (x, y, z) becomes (x, -z, y).
faces = {}
for mesh_object in (o for o in bpy.data.objects if o.type == "MESH"):
    mesh = mesh_object.data
    colours = mesh.color_attributes[0]
    for face in mesh.polygons:
        centre = mesh_object.matrix_world @ face.center
        corner = [colours.data[i if colours.domain == "CORNER" else mesh.loops[i].vertex_index]
                  for i in face.loop_indices]
        place = (centre.x, centre.z, -centre.y)
        normal = (face.normal.x, face.normal.z, -face.normal.y)
        faces.setdefault(mesh_object.name, []).append((place, normal, corner[0].color[:3]))
all_faces = [f for group in faces.values() for f in group]



def srgb(x):
    x = min(max(x, 0.0), 1.0)
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


rows = list(csv.DictReader(open(table)))
random.seed(1)
worst = 0.0
for row in random.sample(rows, 50):
    centre = [float(row[k]) for k in "xyz"]
    normal = [float(row["n" + k]) for k in "xyz"]
    best = min((f for f in all_faces if sum(a * b for a, b in zip(f[1], normal)) > 0.99),
               key=lambda f: sum((a - b) ** 2 for a, b in zip(f[0], centre)))
    wanted = [extras["exposure"] * float(row["radiosity_" + b]) for b in "rgb"]
    worst = max([worst] + [255 * abs(srgb(a) - srgb(b)) for a, b in zip(best[2], wanted)])
print("blender: 50 patches, largest difference %.2f of 255 levels" % worst)
sys.exit(0 if worst < 1 else 1)
