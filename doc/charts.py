# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The charts of the manual as SVG: colours that the colour-blind tell apart (Okabe and Ito 2008), and dashes and marks for print without any.

import math

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]
DASHES = ["", "7,3", "2,3", "9,3,2,3", "14,4", "4,4"]
GREY = "#767676"


def text(x, y, words, size=12, anchor="middle", extra=""):
    words = str(words).replace("&", "&amp;").replace("<", "&lt;")
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-family="sans-serif" font-size="{size}" text-anchor="{anchor}" {extra}>'
            f"{words}</text>\n")


def svg(width, height, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{width}" '
            f'height="{height}" viewBox="0 0 {width} {height}">\n<rect width="{width}" height="{height}" fill="white"/>\n'
            f"{body}</svg>\n")


def label(value):
    if abs(value) >= 1e6:
        return f"{value / 1e6:g} M"
    return f"{value / 1e3:g},000" if value >= 1e3 and value % 1e3 == 0 else f"{value:g}".replace("-", "−")


class Axis:
    """From `low` to `high`, with lines at `ticks`: by default at powers of ten (`log`) or at round numbers."""

    def __init__(self, title, low, high, log=False, ticks=None):
        self.title, self.low, self.high, self.log = title, low, high, log
        if ticks is None and log:
            ticks = [10.0**e for e in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)]
        elif ticks is None:
            step = 10.0 ** math.floor(math.log10((high - low) / 2))
            step = next(s for s in (step / 2, step, 2 * step, 5 * step) if (high - low) / s <= 7)
            ticks = [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
        self.ticks = ticks

    def place(self, value):
        """Where a value is, from 0 to 1."""
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


class Curve:
    def __init__(self, name, points, style=0, colour=None, dash=None, marks=True):
        self.name, self.points, self.marks = name, points, marks
        self.colour = COLOURS[style % 6] if colour is None else colour
        self.dash = DASHES[style % 6] if dash is None else dash

    def line(self, points):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dash = f' stroke-dasharray="{self.dash}"' if self.dash else ""
        drawn = f'<polyline points="{path}" fill="none" stroke="{self.colour}" stroke-width="2"{dash}/>\n'
        if self.marks:
            drawn += "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{self.colour}"/>\n' for x, y in points)
        return drawn


def panel(x0, y0, width, height, title, x, y, curves):
    """One diagram with its axes; x0, y0 is the upper left corner of the square within them."""

    def place(point):
        return x0 + width * x.place(point[0]), y0 + height * (1 - y.place(point[1]))

    body = text(x0 + width / 2, y0 - 12, title, 13, extra='font-weight="bold"')
    for tick in x.ticks:
        at = x0 + width * x.place(tick)
        body += f'<line x1="{at:.1f}" y1="{y0}" x2="{at:.1f}" y2="{y0 + height}" stroke="#ddd"/>\n' + text(at, y0 + height + 16, label(tick))
    for tick in y.ticks:
        at = y0 + height * (1 - y.place(tick))
        body += f'<line x1="{x0}" y1="{at:.1f}" x2="{x0 + width}" y2="{at:.1f}" stroke="#ddd"/>\n' + text(x0 - 6, at + 4, label(tick), anchor="end")
    body += f'<rect x="{x0}" y="{y0}" width="{width}" height="{height}" fill="none" stroke="{GREY}"/>\n'
    body += text(x0 + width / 2, y0 + height + 34, x.title)
    if y.title:
        at = x0 - 46, y0 + height / 2
        body += text(*at, y.title, extra=f'transform="rotate(-90 {at[0]:.1f} {at[1]:.1f})"')
    for curve in curves:
        inside = [p for p in curve.points if x.low <= p[0] <= x.high and y.low <= p[1] <= y.high]
        body += curve.line([place(p) for p in inside])
    return body


def legend(x0, y0, width, curves):
    """The names of curves from left to right, `width` for each."""
    body = ""
    for i, curve in enumerate(curves):
        x = x0 + width * i
        body += Curve("", [], colour=curve.colour, dash=curve.dash, marks=False).line([(x, y0 - 4), (x + 30, y0 - 4)])
        if curve.marks:
            body += f'<circle cx="{x + 15:.1f}" cy="{y0 - 4:.1f}" r="3" fill="{curve.colour}"/>\n'
        body += text(x + 36, y0, curve.name, anchor="start")
    return body
