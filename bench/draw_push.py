#!/usr/bin/env python3
"""Draws a scene of `poise push` as an SVG: bodies from the side at a few times, hips from above.

  poise push --people line:10 --push 0:strong --out line
  draw_push.py line/scene.json docs/images/push_line.svg [SECONDS...]

Bodies are drawn along the first push's direction; every file is a BVH in metres or centimetres as
`poise push` writes it.
"""
import json
import math
import os
import sys

WIDTH, MARGIN, GAP = 860, 44, 12
TOP_HEIGHT = 230
INK, SOFT, PUSHED = "#333333", "#b8b8b8", "#d1495b"


class Motion:
    """Joint places of a BVH file."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            words = file.read().split()
        self.parents, self.offsets, self.channels = [], [], []
        self.rows, self.frame_time = [], 0
        self._read(words)

    def _read(self, words):
        stack, place = [], 0
        while words[place] != "MOTION":
            word = words[place]
            if word in ("ROOT", "JOINT", "End"):
                self.parents.append(stack[-1] if stack else -1)
                self.channels.append([])
                self.offsets.append([0.0, 0.0, 0.0])
                stack.append(len(self.parents) - 1)
            elif word == "OFFSET":
                self.offsets[stack[-1]] = [float(w) for w in words[place + 1:place + 4]]
            elif word == "CHANNELS":
                count = int(words[place + 1])
                self.channels[stack[-1]] = words[place + 2:place + 2 + count]
            elif word == "}":
                stack.pop()
            place += 1
        frames = int(words[place + 2])
        self.frame_time = float(words[place + 5])
        numbers = [float(w) for w in words[place + 6:]]
        width = len(numbers) // frames
        self.rows = [numbers[i * width:(i + 1) * width] for i in range(frames)]

    def places(self, frame):
        row, used = self.rows[min(frame, len(self.rows) - 1)], 0
        turns, places = [], []
        for parent, offset, channels in zip(self.parents, self.offsets, self.channels):
            local, moved = identity(), list(offset)
            for channel in channels:
                value, axis = row[used], "XYZ".index(channel[0])
                used += 1
                if channel.endswith("position"):
                    moved[axis] = value
                else:
                    local = times(local, turn(axis, math.radians(value)))
            if parent < 0:
                turns.append(local)
                places.append(moved)
            else:
                turns.append(times(turns[parent], local))
                shift = [sum(turns[parent][i][k] * moved[k] for k in range(3)) for i in range(3)]
                places.append([places[parent][i] + shift[i] for i in range(3)])
        return places


def identity():
    return [[float(i == j) for j in range(3)] for i in range(3)]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turn(axis, angle):
    matrix, i, j = identity(), (axis + 1) % 3, (axis + 2) % 3
    matrix[i][i] = matrix[j][j] = math.cos(angle)
    matrix[i][j], matrix[j][i] = -math.sin(angle), math.sin(angle)
    return matrix


def text(x, y, words, anchor="start", colour=INK):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="12" fill="{colour}" '
            f'text-anchor="{anchor}">{words}</text>')


def line(a, b, colour, width):
    return (f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" '
            f'stroke="{colour}" stroke-width="{width}" stroke-linecap="round"/>')


def main(scene_path, out_path, times_s):
    with open(scene_path, encoding="utf-8") as file:
        scene = json.load(file)
    folder = os.path.dirname(scene_path)
    people = [Motion(os.path.join(folder, person["file"])) for person in scene["people"]]
    # The unit: a standing body is about 1.7 m high.
    heights = [place[1] for place in people[0].places(0)]
    unit = 1.0 if max(heights) - min(heights) < 10 else 0.01
    impulse = scene["pushes"][0]["impulse_ns"] if scene["pushes"] else [1, 0]
    size = math.hypot(*impulse) or 1
    forward = [impulse[0] / size, impulse[1] / size]
    pushed = {push["person"] for push in scene["pushes"]}

    def along(place):
        return unit * (place[0] * forward[0] + place[2] * forward[1])

    def across(place):
        return unit * (place[2] * forward[0] - place[0] * forward[1])

    paths = [[m.places(f)[0] for f in range(0, len(m.rows), 3)] for m in people]
    flat = [p for path in paths for p in path]
    low, high = min(map(along, flat)) - 0.6, max(map(along, flat)) + 0.6
    scale = min((WIDTH - 2 * MARGIN) / (high - low), 90)
    side = 1.9 * scale
    height = MARGIN + len(times_s) * (side + GAP) + TOP_HEIGHT
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height:.0f}" '
           f'font-family="sans-serif">', f'<rect width="100%" height="100%" fill="white"/>',
           text(MARGIN, 22, f'{len(people)} people, model {scene["model"]}')]
    for index, moment in enumerate(times_s):
        floor = MARGIN + (index + 1) * (side + GAP) - GAP
        out.append(line((MARGIN, floor), (WIDTH - MARGIN, floor), SOFT, 1))
        out.append(text(4, floor - 4, f"{moment:g} s"))
        for number, motion in enumerate(people):
            places = motion.places(round(moment / motion.frame_time))
            drawn = [(MARGIN + scale * (along(p) - low), floor - scale * unit * p[1]) for p in places]
            colour = PUSHED if number in pushed else INK
            bones = "".join(f"M{drawn[parent][0]:.0f} {drawn[parent][1]:.0f}"
                            f"L{drawn[joint][0]:.0f} {drawn[joint][1]:.0f}"
                            for joint, parent in enumerate(motion.parents) if parent >= 0
                            if drawn[parent] != drawn[joint])
            out.append(f'<path d="{bones}" stroke="{colour}" stroke-width="1.5" fill="none"/>')
    top = height - TOP_HEIGHT
    middle = top + TOP_HEIGHT / 2 + 10
    centre = sum(map(across, flat)) / len(flat)
    spread = max(abs(across(p) - centre) for p in flat) + 0.3
    narrow = min(1.0, (TOP_HEIGHT / 2 - 30) / (scale * spread))
    out.append(text(MARGIN, top + 24, "hips from above; the time of the first movement in seconds"))
    for number, (path, person) in enumerate(zip(paths, scene["people"])):
        points = [(MARGIN + scale * (along(p) - low), middle + narrow * scale * (across(p) - centre))
                  for p in path]
        colour = PUSHED if number in pushed else INK
        out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="' +
                   " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')
        out.append(f'<circle cx="{points[0][0]:.1f}" cy="{points[0][1]:.1f}" r="4" '
                   f'fill="{colour}"/>')
        onset = person["onset_s"]
        out.append(text(points[0][0], points[0][1] - 8, "" if onset is None else f"{onset:.2f}",
                        "middle"))
    out.append("</svg>")
    with open(out_path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], [float(word) for word in sys.argv[3:]] or [0, 0.5, 1, 2])
