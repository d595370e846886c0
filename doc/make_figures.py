#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the figures of the manual from runs of the example programs on the shape of the demonstration:
#   doc/make_figures.py BUILD [FOLDER]
# BUILD is where the programs were built; what they write goes to FOLDER (BUILD/figures) and is used again when it is
# there. Needs nothing but Python 3.

import base64
import json
import math
import os
import re
import struct
import subprocess
import sys
import zlib

from make_results import name, norms

K = 100
SIZES = [100, 150, 200, 300, 450, 600, 900, 1400, 2000]
COLOURS = {"spectral": "#01508c", "relocated": "#56a4d8", "isotropic": "#c8501e", "floor": "#888888"}


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


# --- PNG -------------------------------------------------------------------------------------------------------------


class Image:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.pixels = bytearray(b"\xff" * (3 * width * height))

    def set(self, x, y, colour):
        k = 3 * (y * self.width + x)
        self.pixels[k:k + 3] = bytes(colour)

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


# Orthographic, seen from the side and a little from above; the light stands behind the eye.
def render(mesh, name, size, wire):
    rows, triangles, column = mesh
    values = [r[column[name]] for r in rows]
    scale = sorted(abs(v) for v in values)[int(0.98 * len(values))]
    turn, tilt = math.radians(60), math.radians(18)
    points = []
    for x, y, z in (r[:3] for r in rows):
        a, b = math.cos(turn) * x + math.sin(turn) * y, -math.sin(turn) * x + math.cos(turn) * y
        points.append((a, z * math.cos(tilt) + b * math.sin(tilt), -b * math.cos(tilt) + z * math.sin(tilt)))
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
    render(read_ply(path), f"eigenvector_{mode}", (2 * side, 2 * side), wire).write(picture)
    with open(picture, "rb") as file:
        return "data:image/png;base64," + base64.b64encode(file.read()).decode()


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
    columns = [("col/fine.ply", "the input", None)]
    for simplifier, relocation, title in wanted:
        row = next(r for r in rows_of(folder) if r["simplifier"] == simplifier and r["placement"] == "free" and r["relocation"] == relocation)
        columns.append((f"col/{re.sub('[^A-Za-z0-9]+', '_', name(row))}_600.ply", title, row))
    strip(folder, os.path.join(output, "steps.svg"), columns)


# K = 100 modes on fewer and fewer vertices.
def sizes(folder, output):
    with open(os.path.join(folder, "sizes.json")) as file:
        rows = [r for r in json.load(file)["rows"] if r["simplifier"] == "spectral, best"]
    stem = re.sub("[^A-Za-z0-9]+", "_", name(rows[0]))
    strip(folder, os.path.join(output, "sizes.svg"), [("sizes/fine.ply", "the input", None)] + [
        (f"sizes/{stem}_{r['vertices']}.ply", f"N = {r['vertices']}", r) for r in sorted(rows, key=lambda r: -r["vertices"])])


# --- charts ----------------------------------------------------------------------------------------------------------


def text(x, y, words, size=12, anchor="middle", extra=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-family="sans-serif" font-size="{size}" text-anchor="{anchor}" {extra}>'
            f"{words}</text>\n")


def svg(width, height, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{width}" '
            f'height="{height}" viewBox="0 0 {width} {height}">\n<rect width="{width}" height="{height}" fill="white"/>\n'
            f"{body}</svg>\n")


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


def curve(folder, output):
    lines = {}
    with open(os.path.join(folder, "curve.json")) as file:
        for r in json.load(file)["rows"]:
            key = "isotropic" if r["simplifier"] == "isotropic remeshing" else "spectral"
            if key == "spectral" and (r["simplifier"] not in ("spectral, best", "spectral with shape term") or
                                      r["placement"] != "free" or r["metric_mass"] != r["judged_mass"] or
                                      r["relocation"] not in ("none", "sampled")):
                continue
            line = "relocated" if r["relocation"] != "none" else key
            lines.setdefault((r["judged_mass"], line), []).append(
                (r["vertices"], norms(r)["norm_L"], norms(r)["norm_D"], 100 * r["eigenvalue_error_mean"]))
            if line == "spectral":
                lines.setdefault((r["judged_mass"], "floor"), []).append(
                    (r["requested_vertices"], r["floor_norm_L"], r["floor_norm_D"], None))
    body = ""
    panels = [("averaged", 1, "|C|_L, averaged mass", (0.3, 1000)), ("averaged", 2, "|C|_D, averaged mass", (0.1, 20)),
              ("averaged", 3, "eigenvalue error, %, averaged mass", (0.1, 100)), ("lumped", 1, "|C|_L, lumped mass", (5, 1000))]
    for p, (mass, quantity, title, (low, high)) in enumerate(panels):
        x0, y0, w, h = 50 + 270 * (p % 2) * 1.5, 30 + 250 * (p // 2), 330, 190
        body += text(x0 + w / 2, y0 - 10, title) + f'<rect x="{x0}" y="{y0}" width="{w}" height="{h}" fill="none" stroke="#888"/>\n'

        def place(n, v):
            return (x0 + w * math.log(n / 90) / math.log(2200 / 90),
                    y0 + h * (1 - math.log(v / low) / math.log(high / low)))

        x, _ = place(3 * K, low)
        body += f'<line x1="{x:.1f}" y1="{y0}" x2="{x:.1f}" y2="{y0 + h}" stroke="#2a2" stroke-dasharray="4 3"/>\n'
        body += text(x + 3, y0 + 12, "N = 3 K", 10, "start")
        tick = 10 ** math.ceil(math.log10(low))
        while tick <= high:
            y = place(K, tick)[1]
            body += f'<line x1="{x0}" y1="{y:.1f}" x2="{x0 + w}" y2="{y:.1f}" stroke="#ddd"/>\n' + text(x0 - 4, y + 4, f"{tick:g}", 10, "end")
            tick *= 10
        for n in (100, 200, 300, 600, 1000, 2000):
            body += text(place(n, low)[0], y0 + h + 13, n, 10)
        for key, colour in COLOURS.items():
            points = sorted((n, row[quantity]) for row in lines.get((mass, key), []) for n in [row[0]] if row[quantity])
            path = " ".join("{:.1f},{:.1f}".format(*place(n, v)) for n, v in points)
            dash = ' stroke-dasharray="2 3"' if key == "floor" else ""
            body += f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>\n'
            if key != "floor":
                body += "".join('<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>\n'.format(*place(n, v), colour) for n, v in points)
    names = {"spectral": "spectral, policies", "relocated": "spectral, best", "isotropic": "isotropic remeshing",
             "floor": "ideal elements (estimate)"}
    for i, (key, colour) in enumerate(COLOURS.items()):
        body += f'<rect x="{60 + 190 * i}" y="515" width="14" height="4" fill="{colour}"/>\n' + text(80 + 190 * i, 521, names[key], 11, "start")
    with open(os.path.join(output, "norms_over_n.svg"), "w") as file:
        file.write(svg(810, 532, body))


# From the tables of results.md: times of one quiet run there, which runs for pictures are not.
def timings(output):
    title = "## rocker-arm.obj, 10044 vertices, N = 600"
    with open(os.path.join(output, "..", "results.md")) as file:
        table = file.read().split(title)[1].split("Judged in the lumped mass")[0]
    bars = []
    for line in table.splitlines():
        cells = [c.strip(" *") for c in line.strip("|").split("|")]
        if len(cells) > 5 and re.fullmatch(r"[0-9.]+", cells[-1]):
            bars.append((cells[0], float(cells[-1])))
    longest = max(seconds for _, seconds in bars)
    body = text(10, 18, "Seconds from 10,044 to 600 vertices, one thread; spectral: eigenpairs included", 12, "start")
    for i, (name, seconds) in enumerate(bars):
        y = 30 + 22 * i
        body += text(290, y + 12, name, 11, "end")
        body += f'<rect x="296" y="{y}" width="{400 * seconds / longest:.1f}" height="16" fill="#01508c"/>\n'
        body += text(300 + 400 * seconds / longest, y + 12, f"{seconds:.2f}", 11, "start")
    with open(os.path.join(output, "timings.svg"), "w") as file:
        file.write(svg(760, 40 + 22 * len(bars), body))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: make_figures.py BUILD [FOLDER]")
    folder = os.path.abspath(sys.argv[2] if len(sys.argv) == 3 else os.path.join(sys.argv[1], "figures"))
    run_all(sys.argv[1], folder)
    output = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fig")
    os.makedirs(output, exist_ok=True)
    functional_maps(folder, output)
    teaser(folder, output)
    steps(folder, output)
    sizes(folder, output)
    curve(folder, output)
    timings(output)


if __name__ == "__main__":
    main()
