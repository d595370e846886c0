#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the figures of the manual from runs of the example programs on the shape of the demonstration and on a terrain, and from the tables
# of times in doc/:
#   doc/make_figures.py BUILD [FOLDER]
# BUILD is where the programs were built; what they write goes to FOLDER (BUILD/figures) and is used again when it is
# there. What the manual quotes of it goes to doc/figures.json. Needs nothing but Python 3.

import base64
import csv
import json
import math
import os
import re
import struct
import subprocess
import sys
import zlib

from charts import GREY, Axis, Curve, legend, panel, svg, text
from make_results import commit, name, norms

HERE = os.path.dirname(os.path.abspath(__file__))
K = 100
SIZES = [100, 150, 200, 300, 450, 600, 900, 1400, 2000]
FLANK = (-0.6, -0.35, 0.2, 0.45) # of the demonstration shape as it is seen
# The terrain's runs: what stands above the picture, and the options.
BORDERS = {"paper": ("the paper's metric", ["--preset", "paper", "--mass", "averaged"]),
           "preserved": ("with preserve_border", ["--preset", "paper", "--mass", "averaged", "--preserve-border"]),
           "best": ("preset best", [])}


def run(build, folder, output, program, *arguments):
    if not os.path.exists(os.path.join(folder, output)):
        subprocess.run([os.path.abspath(os.path.join(build, "examples", program)), *arguments], check=True, cwd=folder)


def run_all(build, folder):
    os.makedirs(folder, exist_ok=True)
    run(build, folder, "shape.ply", "make_demo_shape", "shape.ply", "--vertices", "10000")
    run(build, folder, "all.json", "spectral_compare", "shape.ply", "--vertices", "600", "--judge", "averaged",
        "--report", "all.html", "--coloured", "col", "--json", "all.json", "--quiet")
    sizes = ",".join(str(n) for n in SIZES)
    run(build, folder, "curve.json", "spectral_compare", "shape.ply", "--vertices", sizes, "--only", "spectral", "--only", "isotropic",
        "--judge", "lumped,averaged", "--json", "curve.json", "--quiet")
    run(build, folder, "sizes.json", "spectral_compare", "shape.ply", "--vertices", "150,300,2000", "--only", "spectral, best", "--judge",
        "averaged", "--coloured", "sizes", "--json", "sizes.json", "--quiet")
    run(build, folder, "masses.json", "spectral_compare", "shape.ply", "--vertices", "600", "--only", "spectral, best", "--judge",
        "lumped,averaged", "--json", "masses.json", "--quiet")
    run(build, folder, "pairs", "spectral_simplify", "shape.ply", "coarse.off", "--vertices", "600", "--eigenpairs", "pairs", "--quiet")
    terrain(os.path.join(folder, "terrain.off"))
    for stem, (_, options) in BORDERS.items():
        run(build, folder, f"border_{stem}.json", "spectral_simplify", "terrain.off", f"border_{stem}.off", "--vertices", "300", *options,
            "--json", f"border_{stem}.json", "--quiet")


# An island whose border has bays, of 7,651 vertices.
def terrain(path, rings=50):
    points, rows, triangles = [(0, 0)], [[0]], []
    for j in range(1, rings + 1):
        rows.append([])
        for i in range(6 * j):
            turn, r = 2 * math.pi * i / (6 * j), j / rings
            r *= 1 + r * (0.12 * math.cos(5 * turn) + 0.06 * math.cos(11 * turn + 1) + 0.03 * math.cos(23 * turn))
            rows[j].append(len(points))
            points.append((r * math.cos(turn), r * math.sin(turn)))
        for i in range(6 * j):
            inner, outer, side = rows[j - 1], rows[j], i // j
            a, b = outer[i], outer[(i + 1) % (6 * j)]
            c, d = inner[(i - side) % len(inner)], inner[(i - side + 1) % len(inner)]
            triangles.append((c, a, b))
            if (i + 1) % j:
                triangles.append((c, b, d))
    with open(path, "w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        for x, y in points:
            file.write(f"{x:.9g} {y:.9g} {0.12 * math.sin(5 * x + 1) * math.cos(4 * y) + 0.04 * math.sin(13 * x - 9 * y):.9g}\n")
        file.writelines("3 {} {} {}\n".format(*t) for t in triangles)


# --- PNG -------------------------------------------------------------------------------------------------------------


class Image:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.pixels = bytearray(b"\xff" * (3 * width * height))

    def set(self, x, y, colour):
        k = 3 * (y * self.width + x)
        self.pixels[k:k + 3] = bytes(colour)

    def paste(self, other, x0, y0):
        for y in range(other.height):
            k = 3 * ((y0 + y) * self.width + x0)
            self.pixels[k:k + 3 * other.width] = other.pixels[3 * y * other.width:3 * (y + 1) * other.width]

    def halved(self):
        half = Image(self.width // 2, self.height // 2)
        for y in range(half.height):
            for x in range(half.width):
                k = [3 * ((2 * y + j) * self.width + 2 * x + i) for j in (0, 1) for i in (0, 1)]
                half.set(x, y, [sum(self.pixels[q + c] for q in k) // 4 for c in range(3)])
        return half

    # Colours are rounded to 32 steps: a file a third of the size.
    def write(self, path):
        table = bytes(min(255, 8 * ((v + 4) // 8)) for v in range(256))
        pixels = self.pixels.translate(table)
        row = 3 * self.width
        raw = b"".join(b"\0" + bytes(pixels[y * row:(y + 1) * row]) for y in range(self.height))

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        with open(path, "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", self.width, self.height, 8, 2, 0, 0, 0)) +
                       chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


# --- meshes ----------------------------------------------------------------------------------------------------------


def read_ply(path):
    with open(path) as file:
        properties, vertices, faces = [], 0, 0
        for line in file:
            words = line.split()
            if words[0] == "element" and words[1] == "vertex":
                vertices = int(words[2])
            elif words[0] == "element":
                faces = int(words[2])
            elif words[0] == "property" and words[1] != "list":
                properties.append(words[2])
            elif words[0] == "end_header":
                break
        rows = [[float(x) for x in next(file).split()] for _ in range(vertices)]
        triangles = [tuple(int(x) for x in next(file).split()[1:4]) for _ in range(faces)]
    return rows, triangles, {name: k for k, name in enumerate(properties)}


# From blue by white to red, t in [-1, 1].
def diverging(t):
    t = max(-1.0, min(1.0, t))
    end = (178, 40, 40) if t > 0 else (1, 80, 140)
    return [255 + (e - 255) * abs(t) for e in end]


# Points of the demonstration shape from the side and a little from above: right, up and towards the eye.
def seen(points):
    turn, tilt, result = math.radians(60), math.radians(18), []
    for x, y, z in (p[:3] for p in points):
        a, b = math.cos(turn) * x + math.sin(turn) * y, -math.sin(turn) * x + math.cos(turn) * y
        result.append((a, z * math.cos(tilt) + b * math.sin(tilt), -b * math.cos(tilt) + z * math.sin(tilt)))
    return result


# Orthographic; the light stands behind the eye. `values` has a number for each vertex.
def render(rows, triangles, values, size, wire):
    scale = sorted(abs(v) for v in values)[int(0.98 * len(values))]
    points = seen(rows)
    low = [min(p[c] for p in points) for c in (0, 1)]
    high = [max(p[c] for p in points) for c in (0, 1)]
    width, height = size
    factor = min((width - 8) / (high[0] - low[0]), (height - 8) / (high[1] - low[1]))
    points = [(width / 2 + factor * (p[0] - (low[0] + high[0]) / 2), height / 2 - factor * (p[1] - (low[1] + high[1]) / 2),
               factor * p[2]) for p in points]
    image, depth = Image(width, height), [-1e30] * (width * height)
    for t in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (points[i] for i in t)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        n = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
        det, length = n[2], math.sqrt(sum(c * c for c in n))
        if abs(det) < 1e-12:
            continue
        light = 0.45 + 0.55 * abs(det) / length
        va, vb, vc = (values[i] / scale for i in t)
        for y in range(max(0, math.ceil(min(ay, by, cy))), min(height - 1, math.floor(max(ay, by, cy))) + 1):
            for x in range(max(0, math.ceil(min(ax, bx, cx))), min(width - 1, math.floor(max(ax, bx, cx))) + 1):
                s = ((x - ax) * vy - (y - ay) * vx) / det
                r = (ux * (y - ay) - uy * (x - ax)) / det
                if s < 0 or r < 0 or s + r > 1:
                    continue
                z = az + s * uz + r * vz
                if z > depth[y * width + x]:
                    depth[y * width + x] = z
                    edge = wire and min(s * abs(det) / math.hypot(vx, vy), r * abs(det) / math.hypot(ux, uy),
                                        (1 - s - r) * abs(det) / math.hypot(vx - ux, vy - uy)) < 0.7
                    shade = light * (0.55 if edge else 1)
                    image.set(x, y, [int(shade * c) for c in diverging(va + s * (vb - va) + r * (vc - va))])
    return image.halved()


# The first picture of README and manual: a mode on the input and on what two simplifiers made of it, their functional maps below.
def teaser(folder, output):
    mode, side = modes_apart(folder)[1], 230
    columns = [("fine", "", "the input, 10,039 vertices"),
               ("spectral_best_free_averaged_metric_relocated_by_sampled_600", "spectral, best", "this package, 600"),
               ("Garland_Heckbert_probabilistic_plane_area_20000_optimal_600", "Garland-Heckbert probabilistic plane, area 20000",
                "probabilistic quadrics, 600"),
               ("Garland_Heckbert_plane_optimal_600", "Garland-Heckbert plane", "plane quadrics, 600")]
    maps, rows, body = images_of_maps(folder), rows_of(folder), ""
    for i, (stem, simplifier, title) in enumerate(columns):
        x = 10 + (side + 10) * i
        data = pictured(os.path.join(folder, "col", stem + ".ply"), mode, side, i > 0)
        body += text(x + side / 2, 18, title, 13) + f'<image x="{x}" y="24" width="{side}" height="{side}" xlink:href="{data}"/>\n'
        if not simplifier:
            body += "".join(text(x + side / 2, 24 + 1.35 * side + 18 * k, line) for k, line in enumerate(
                (f"Above: eigenfunction {mode}, where it is", "positive red, where it is negative blue.", "",
                 "Right: |C|, the first 100 functions of", "the input in those of the result.", "Perfect: a thin diagonal, |C|_L = 0.")))
            continue
        row = next(r for r in rows if r["simplifier"] == simplifier and r["placement"] != "midpoint")
        y = 24 + side + 6
        body += (f'<image x="{x + 15}" y="{y}" width="{side - 30}" height="{side - 30}" xlink:href="{maps[name(row)]}" '
                 f'style="image-rendering:pixelated"/>\n<rect x="{x + 15}" y="{y}" width="{side - 30}" height="{side - 30}" '
                 f'fill="none" stroke="#888"/>\n')
        body += text(x + side / 2, y + side - 12, f"|C|_L {norms(row)['norm_L']:.1f}, eigenvalues {100 * row['eigenvalue_error_mean']:.2f} % off", 13)
    with open(os.path.join(output, "teaser.svg"), "w") as file:
        file.write(svg(10 + (side + 10) * len(columns), 34 + 2 * side, body))


# Three modes whose eigenvalues are a tenth away from others: nearly equal ones may mix, whoever simplifies.
def modes_apart(folder):
    with open(os.path.join(folder, "all.json")) as file:
        values = json.load(file)["fine"][0]["eigenvalues"]
    apart = [k for k in range(2, 11) if all(abs(values[k - 1] - values[j]) > 0.1 * values[k - 1] for j in (k - 2, k))]
    return apart[0], apart[len(apart) // 2], apart[-1]


# The mesh in a PLY file with a mode of it, as data for an SVG.
def pictured(path, mode, side, wire):
    picture = path[:-len(".ply")] + ".png"
    rows, triangles, column = read_ply(path)
    render(rows, triangles, [r[column[f"eigenvector_{mode}"]] for r in rows], (2 * side, 2 * side), wire).write(picture)
    with open(picture, "rb") as file:
        return "data:image/png;base64," + base64.b64encode(file.read()).decode()


# A column of a NumPy array of float64.
def column_of(path, column):
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack("<H", data[8:10])[0]
    header = data[10:10 + length].decode()
    n, m = (int(x) for x in re.search(r"\((\d+), (\d+)\)", header).groups())
    numbers = struct.unpack(f"<{n * m}d", data[10 + length:])
    return numbers[column * n:(column + 1) * n] if "'fortran_order': True" in header else numbers[column::m]


# Eigenfunctions of the input: how small the features are that K of them tell apart.
def modes(folder, output):
    rows, triangles, _ = read_ply(os.path.join(folder, "col/fine.ply"))
    side, body = 260, ""
    for i, k in enumerate((10, 30, 100)):
        x, picture = 10 + (side + 10) * i, os.path.join(folder, f"mode_{k}.png")
        render(rows, triangles, column_of(os.path.join(folder, "pairs/fine_eigenvectors.npy"), k - 1), (2 * side, 2 * side), False).write(picture)
        with open(picture, "rb") as file:
            data = base64.b64encode(file.read()).decode()
        body += text(x + side / 2, 18, f"eigenfunction {k}", 13, extra='font-weight="bold"')
        body += f'<image x="{x}" y="24" width="{side}" height="{side}" xlink:href="data:image/png;base64,{data}"/>\n'
    with open(os.path.join(output, "modes.svg"), "w") as file:
        file.write(svg(10 + (side + 10) * 3, side + 34, body))


# Meshes side by side, (PLY file, what stands above it, the row of its figures or none).
def strip(folder, output, columns):
    mode, side, body = modes_apart(folder)[1], 200, ""
    for i, (path, title, row) in enumerate(columns):
        x = 10 + (side + 10) * i
        body += text(x + side / 2, 16, title) + f'<image x="{x}" y="22" width="{side}" height="{side}" ' \
            f'xlink:href="{pictured(os.path.join(folder, path), mode, side, i > 0)}"/>\n'
        if row:
            body += text(x + side / 2, side + 38, f"|C|_L {norms(row)['norm_L']:.1f}, eigenvalues {100 * row['eigenvalue_error_mean']:.1f} % off")
    with open(output, "w") as file:
        file.write(svg(10 + (side + 10) * len(columns), side + 48, body))


# What each step of the preset brings: the paper's metric, the shape term, relocation.
def steps(folder, output):
    wanted = [("spectral", "none", "the paper's metric"), ("spectral with shape term", "none", "with the shape term"),
              ("spectral, best", "sampled", "relocated: the preset best")]
    columns, data = [("col/fine.ply", "the input", None)], []
    for simplifier, relocation, title in wanted:
        row = next(r for r in rows_of(folder) if r["simplifier"] == simplifier and r["placement"] == "free" and r["relocation"] == relocation)
        columns.append((f"col/{re.sub('[^A-Za-z0-9]+', '_', name(row))}_600.ply", title, row))
        data.append(norms(row)["norm_L"])
    strip(folder, os.path.join(output, "steps.svg"), columns)
    return data


# K = 100 modes on fewer and fewer vertices.
def sizes(folder, output):
    with open(os.path.join(folder, "sizes.json")) as file:
        rows = [r for r in json.load(file)["rows"] if r["simplifier"] == "spectral, best"]
    stem = re.sub("[^A-Za-z0-9]+", "_", name(rows[0]))
    strip(folder, os.path.join(output, "sizes.svg"), [("sizes/fine.ply", "the input", None)] + [
        (f"sizes/{stem}_{r['vertices']}.ply", f"N = {r['vertices']}", r) for r in sorted(rows, key=lambda r: -r["vertices"])])


# --- meshes of few triangles as polygons -------------------------------------------------------------------------------


def read_off(path):
    with open(path) as file:
        words = file.read().split()
    n, m = int(words[1]), int(words[2])
    numbers = [float(x) for x in words[4:4 + 3 * n]]
    faces = [int(x) for x in words[4 + 3 * n:4 + 3 * n + 4 * m]]
    return [tuple(numbers[3 * i:3 * i + 3]) for i in range(n)], [tuple(faces[4 * i + 1:4 * i + 4]) for i in range(m)]


# The vertices of the border in order.
def border_of(triangles):
    edges = {(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loop = [min(following)]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
    return loop


def plan_area(points, triangles):
    return sum((points[b][0] - points[a][0]) * (points[c][1] - points[a][1]) - (points[c][0] - points[a][0]) * (points[b][1] - points[a][1])
               for a, b, c in triangles) / 2


# A point, seen along z, of a box in the plane within a frame (x, y, width, height) of the figure.
def framed(point, frame, box):
    x0, y0, width, height = frame
    return x0 + width * (point[0] - box[0]) / (box[2] - box[0]), y0 + height * (1 - (point[1] - box[1]) / (box[3] - box[1]))


# The vertices of the box whose triangles all face the eye, as those of a flank do.
def front_vertices(points, triangles, box):
    behind = {v for t in triangles for v in t if plan_area(points, [t]) <= 0}
    return [v for v, p in enumerate(points) if v not in behind and box[0] < p[0] < box[2] and box[1] < p[1] < box[3]]


# The triangles that are within the box and face the eye, from back to front.
def drawing(points, triangles, frame, box):
    faces = []
    for t in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (points[v][:3] for v in t)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        n = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
        inside = max(ax, bx, cx) > box[0] and min(ax, bx, cx) < box[2] and max(ay, by, cy) > box[1] and min(ay, by, cy) < box[3]
        if n[2] > 0 and inside:
            faces.append(((az + bz + cz) / 3, n[2] / math.sqrt(sum(c * c for c in n)), t))
    x0, y0, width, height = frame
    clip = f"clip{x0}"
    body = f'<clipPath id="{clip}"><rect x="{x0}" y="{y0}" width="{width}" height="{height}"/></clipPath>\n'
    body += f'<g clip-path="url(#{clip})" stroke="#444" stroke-width="0.7" stroke-linejoin="round">\n'
    for _, light, t in sorted(faces):
        path = " ".join("{:.1f},{:.1f}".format(*framed(points[v], frame, box)) for v in t)
        body += f'<polygon points="{path}" fill="rgb({",".join(str(int(c * (0.5 + 0.5 * light))) for c in (214, 230, 244))})"/>\n'
    return body + "</g>\n"


# --- charts ----------------------------------------------------------------------------------------------------------


# The maps as the report of spectral_compare draws them, |C| from white to dark blue.
def images_of_maps(folder):
    with open(os.path.join(folder, "all.html")) as file:
        return dict(re.findall(r"<img alt='\|C\| of ([^']*)' src='(data:image/png;base64,[^']*)'", file.read()))


def rows_of(folder):
    with open(os.path.join(folder, "all.json")) as file:
        return json.load(file)["rows"]


def functional_maps(folder, output):
    images, rows = images_of_maps(folder), rows_of(folder)
    wanted = [("spectral, best, free, averaged metric, relocated by sampled", "spectral, best", "spectral, best"),
              ("isotropic remeshing", "isotropic remeshing", "isotropic remeshing"),
              ("edge length, midpoint", "edge length", "edge length, midpoint"),
              ("Garland-Heckbert plane, optimal", "Garland-Heckbert plane", "Garland-Heckbert, plane")]
    body = ""
    for i, (title_of_map, simplifier, title) in enumerate(wanted):
        row = next(r for r in rows if r["simplifier"] == simplifier and r["placement"] != "midpoint" or
                   r["simplifier"] == simplifier == "edge length")
        x = 10 + 205 * i
        body += (f'<image x="{x}" y="26" width="195" height="195" xlink:href="{images[title_of_map]}" '
                 f'style="image-rendering:pixelated"/>\n<rect x="{x}" y="26" width="195" height="195" fill="none" stroke="#888"/>\n')
        body += text(x + 97, 18, title)
        body += text(x + 97, 238, f"|C|_L {norms(row)['norm_L']:.1f}, |C|_D {norms(row)['norm_D']:.2f}")
    with open(os.path.join(output, "functional_maps.svg"), "w") as file:
        file.write(svg(830, 250, body))


# The norms over N: for each mass and line the points (N, |C|_L, |C|_D, error of the eigenvalues in percent).
def lines_over_n(folder):
    lines = {}
    with open(os.path.join(folder, "curve.json")) as file:
        for r in json.load(file)["rows"]:
            key = "isotropic" if r["simplifier"] == "isotropic remeshing" else "policies"
            if key == "policies" and (r["simplifier"] not in ("spectral, best", "spectral with shape term") or
                                      r["placement"] != "free" or r["metric_mass"] != r["judged_mass"] or
                                      r["relocation"] not in ("none", "sampled")):
                continue
            line = "best" if r["relocation"] != "none" else key
            lines.setdefault((r["judged_mass"], line), []).append(
                (r["vertices"], norms(r)["norm_L"], norms(r)["norm_D"], 100 * r["eigenvalue_error_mean"]))
            if line == "policies":
                lines.setdefault((r["judged_mass"], "floor"), []).append(
                    (r["requested_vertices"], r["floor_norm_L"], r["floor_norm_D"], None))
    return {key: sorted(points) for key, points in lines.items()}


def curve(folder, output):
    lines, body = lines_over_n(folder), ""
    names = {"policies": ("spectral, not relocated", {"style": 0}), "best": ("spectral, best", {"style": 5, "dash": "7,3"}),
             "isotropic": ("isotropic remeshing", {"style": 1, "dash": "9,3,2,3"}),
             "floor": ("ideal elements (estimate)", {"colour": GREY, "dash": "2,3", "marks": False})}
    panels = [("averaged", 1, "|C|_L, averaged mass", (0.3, 1000)), ("averaged", 2, "|C|_D, averaged mass", (0.1, 20)),
              ("averaged", 3, "eigenvalue error in %, averaged mass", (0.1, 100)), ("lumped", 1, "|C|_L, lumped mass", (5, 1000))]
    for p, (mass, quantity, title, (low, high)) in enumerate(panels):
        curves = [Curve("", [(3 * K, low), (3 * K, high)], colour="black", dash="1,3", marks=False)]
        for key, (_, style) in names.items():
            curves.append(Curve("", [(row[0], row[quantity]) for row in lines.get((mass, key), []) if row[quantity]], **style))
        x0, y0 = 60 + 400 * (p % 2), 36 + 270 * (p // 2)
        body += panel(x0, y0, 330, 190, title, Axis("N, vertices; dotted: 3 K", 90, 2200, log=True, ticks=[100, 200, 300, 600, 1000, 2000]),
                      Axis("", low, high, log=True), curves)
    body += legend(40, 566, 195, [Curve(words, [], **style) for words, style in names.values()])
    with open(os.path.join(output, "norms_over_n.svg"), "w") as file:
        file.write(svg(830, 580, body))


# Coarse over fine eigenvalues of one mesh in the mass matrices, its own and fitted ones.
def masses(folder, output):
    with open(os.path.join(folder, "masses.json")) as file:
        data = json.load(file)
    fine = {f["mass"]: f["eigenvalues"] for f in data["fine"]}

    def curve_of(words, mass, fitted, style):
        row = next(r for r in data["rows"] if r["judged_mass"] == mass and r["metric_mass"] == "averaged" and r["placement"] == "free" and
                   r["relocation"] == "sampled" and ("fitted" in r["simplifier"]) == fitted)
        points = [(k + 1, 100 * (row["coarse_eigenvalues"][k] / fine[mass][k] - 1)) for k in range(1, K)]
        return Curve(words, points, style, marks=False), 100 * row["eigenvalue_error_mean"]

    lumped, averaged = curve_of("lumped", "lumped", False, 1), curve_of("averaged", "averaged", False, 0)
    fitted = [curve_of("lumped, fitted", "lumped", True, 3), curve_of("averaged, fitted", "averaged", True, 2)]
    theory = Curve("lumped, even triangles (estimate)", [(k, -100 * 2 * math.pi / (4 * math.sqrt(3)) * k / 600) for k in (1, K)],
                   colour=GREY, dash="2,3", marks=False)
    modes = Axis("mode k", 0, K)
    body = panel(60, 36, 330, 240, "its own operators", modes, Axis("error of eigenvalue k in %", -18, 3, ticks=range(-15, 5, 5)),
                 [theory, lumped[0], averaged[0]])
    body += panel(470, 36, 330, 240, "fitted ones, at a larger scale", modes, Axis("", -2, 3), [averaged[0]] + [f[0] for f in fitted])
    body += legend(40, 336, 115, [lumped[0], averaged[0]]) + legend(270, 336, 145, [fitted[0][0], fitted[1][0], theory])
    with open(os.path.join(output, "masses.svg"), "w") as file:
        file.write(svg(830, 350, body))
    return {"lumped": lumped[1], "averaged": averaged[1], "lumped_fitted": fitted[0][1], "averaged_fitted": fitted[1][1]}


# Where relocation moves the vertices, and what it does to the eigenvalues.
def relocation(folder, output):
    rows = {words: next(r for r in rows_of(folder) if r["simplifier"] == simplifier and r["placement"] == "free" and r["relocation"] == by)
            for words, simplifier, by in (("before", "spectral with shape term", "none"), ("after", "spectral, best", "sampled"))}
    with open(os.path.join(folder, "all.json")) as file:
        fine = json.load(file)["fine"][0]["eigenvalues"]
    meshes = [read_ply(os.path.join(folder, f"col/{re.sub('[^A-Za-z0-9]+', '_', name(row))}_600.ply"))[:2] for row in rows.values()]
    if meshes[0][1] != meshes[1][1]:
        sys.exit("Relocation starts from other collapses than those without it.")
    start = seen(meshes[0][0])
    body, curves = "", []
    for i, (words, row) in enumerate(rows.items()):
        points, frame = seen(meshes[i][0]), (20 + 260 * i, 36, 240, 240)
        body += text(140 + 260 * i, 24, f"{words} relocation", 13, extra='font-weight="bold"') + drawing(points, meshes[i][1], frame, FLANK)
        body += text(140 + 260 * i, 296, f"|C|_L {norms(row)['norm_L']:.1f}, |C|_D {norms(row)['norm_D']:.2f}")
        curves.append(Curve(words, [(k + 1, 100 * abs(row["coarse_eigenvalues"][k] / fine[k] - 1)) for k in range(1, K)], 1 - i, marks=False))
    for v in front_vertices(points, meshes[1][1], FLANK):
        (ax, ay), (bx, by) = framed(start[v], frame, FLANK), framed(points[v], frame, FLANK)
        if ay > frame[1]:
            body += f'<path d="M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}" stroke="#D55E00" stroke-width="2"/>\n'
    body += panel(590, 36, 220, 210, "error of eigenvalue k in %", Axis("mode k", 0, K), Axis("", 0, 5), curves)
    body += legend(620, 296, 100, curves)
    with open(os.path.join(output, "relocation.svg"), "w") as file:
        file.write(svg(830, 310, body))
    return {words: norms(row)["norm_L"] for words, row in rows.items()}


# The terrain from above, with the border that it had.
def borders(folder, output):
    fine, triangles = read_off(os.path.join(folder, "terrain.off"))
    box, body, data = (-1.25, -1.25, 1.25, 1.25), "", {}
    area, outline = plan_area(fine, triangles), border_of(triangles)
    for i, (stem, (title, _)) in enumerate(BORDERS.items()):
        frame = (10 + 275 * i, 30, 260, 260)
        points, coarse = read_off(os.path.join(folder, f"border_{stem}.off"))
        with open(os.path.join(folder, f"border_{stem}.json")) as file:
            run_of = json.load(file)
        data[stem] = {"norm_L": run_of["norm_L"], "eigenvalue_error_percent": 100 * run_of["eigenvalue_error_mean"],
                      "area_percent": 100 * (plan_area(points, coarse) / area - 1)}
        body += text(frame[0] + 130, 20, title, 13, extra='font-weight="bold"') + drawing(points, coarse, frame, box)
        path = " ".join("{:.1f},{:.1f}".format(*framed(fine[v], frame, box)) for v in outline)
        body += f'<polygon points="{path}" fill="none" stroke="#D55E00" stroke-width="1.5"/>\n'
        body += text(frame[0] + 130, 308, f"|C|_L {data[stem]['norm_L']:.1f}, eigenvalues {data[stem]['eigenvalue_error_percent']:.1f} % off")
        body += text(frame[0] + 130, 326, f"area from above {data[stem]['area_percent']:+.1f} %".replace("-", "−"))
    with open(os.path.join(output, "border.svg"), "w") as file:
        file.write(svg(830, 340, body))
    return data


# --- tables of times -------------------------------------------------------------------------------------------------


def table_of(csv_name):
    with open(os.path.join(HERE, csv_name), newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


# `spectral_benchmark --scaling`: shapes of more and more vertices, for several K.
def scaling(output):
    rows = table_of("scaling.csv")
    numbers = sorted({r["eigenvectors"] for r in rows})

    def curves(column):
        return [Curve(f"K = {k:g}", [(r["vertices"], r[column]) for r in rows if r["eigenvectors"] == k], i) for i, k in enumerate(numbers)]

    rival = {}  # measured again for each K: the mean
    for r in rows:
        rival.setdefault(r["vertices"], []).append(r["us_per_collapse_garland_heckbert"])
    collapse = curves("us_per_collapse") + [Curve("Garland-Heckbert", [(n, sum(v) / len(v)) for n, v in sorted(rival.items())], 4)]
    vertices = Axis("vertices", 10000, 1000000, log=True)
    threads = f"{rows[0]['threads']:g}"
    body = panel(70, 36, 320, 240, f"microseconds per collapse, {threads} threads", vertices, Axis("", 5, 200, log=True, ticks=[5, 10, 20, 50, 100, 200]),
                 collapse)
    body += panel(480, 36, 320, 240, "seconds in all, eigenpairs included", vertices, Axis("", 0.2, 500, log=True, ticks=[1, 10, 100]),
                  curves("seconds_total"))
    body += legend(70, 336, 140, collapse)
    with open(os.path.join(output, "scaling.svg"), "w") as file:
        file.write(svg(830, 350, body))


# `spectral_benchmark --scaling-shape disc`: fans of more and more triangles.
def degree(output):
    rows = table_of("degree.csv")

    def curve(words, column, style):
        return Curve(words, [(r["vertices"] - 1, r[column]) for r in rows], style)

    axis = Axis("neighbours of the vertex", 8, 15000, log=True)
    curves = [curve("spectral, best", "us_per_collapse", 0), curve("Garland-Heckbert, plane quadrics", "us_per_collapse_garland_heckbert", 1)]
    body = panel(70, 36, 320, 240, "microseconds per collapse", axis, Axis("", 5, 500000, log=True), curves)
    body += panel(480, 36, 320, 240, "seconds in all, eigenpairs included", axis, Axis("", 0.001, 10, log=True),
                  [curve("", "seconds_total", 0)])
    body += legend(70, 336, 160, curves)
    with open(os.path.join(output, "degree.svg"), "w") as file:
        file.write(svg(830, 350, body))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: make_figures.py BUILD [FOLDER]")
    folder = os.path.abspath(sys.argv[2] if len(sys.argv) == 3 else os.path.join(sys.argv[1], "figures"))
    run_all(sys.argv[1], folder)
    output = os.path.join(HERE, "fig")
    os.makedirs(output, exist_ok=True)
    functional_maps(folder, output)
    teaser(folder, output)
    sizes(folder, output)
    modes(folder, output)
    curve(folder, output)
    scaling(output)
    degree(output)
    data = {"commit": commit(),
            "norms_over_n": [{"mass": mass, "line": line, "points": points} for (mass, line), points in lines_over_n(folder).items()],
            "steps": steps(folder, output), "masses": masses(folder, output), "relocation": relocation(folder, output), "border": borders(folder, output)}
    with open(os.path.join(HERE, "figures.json"), "w") as file:
        json.dump(data, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
