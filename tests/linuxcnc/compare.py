#!/usr/bin/python3
"""Compares the moves that toolglide-program reads with those of LinuxCNC's interpreter.

Usage: compare.py MOVES [--tools TABLE] PROGRAM...

MOVES is the example `moves` of the crate `program` (cargo build --example moves). LinuxCNC's interpreter
is that of the Debian package linuxcnc-uspace, by its Python module `gcode`, which gives all digits.
Ends, centres, axes of arcs and feedrates are compared, in the coordinates of the machine; moves that
lead nowhere are left out on both sides. Prints one line a program and the largest difference of each
kind, and exits with 1 when any is above 1e-6 mm. Splines are compared as curves.
"""

import ctypes
import math
import os
import subprocess
import sys
import tempfile

import gcode

CLOSE = 1e-6  # mm
NOWHERE = 1e-9  # mm
SPLINE = 2e-3  # mm, a tenth of the tolerance of the examples


class Canon:
    """Collects canonical motion, in mm."""

    def __init__(self, tools, variables):
        self.moves = []
        self.feed = 0.0
        self.g5x = [0.0] * 3
        self.g92 = [0.0] * 3
        self.tool = [0.0] * 3
        self.angle = 0.0
        self.plane = 1
        self.line = 0
        self.at = [0.0] * 3
        self.tools = tools
        self.parameter_file = variables

    def machine(self, x, y, z):
        x, y, z = (25.4 * v for v in (x, y, z))
        x, y, z = x + self.g92[0], y + self.g92[1], z + self.g92[2]
        c, s = math.cos(self.angle), math.sin(self.angle)
        x, y = x * c - y * s, x * s + y * c
        return [a + b + t for a, b, t in zip((x, y, z), self.g5x, self.tool)]

    def add(self, kind, end, speed, more=()):
        length = math.dist(end, self.at)
        if kind == "arc" or length > NOWHERE:
            self.moves.append((self.line, kind, speed, end, more))
        self.at = end

    def straight_traverse(self, x, y, z, *_):
        self.add("rapid", self.machine(x, y, z), math.inf)

    def straight_feed(self, x, y, z, *_):
        self.add("feed", self.machine(x, y, z), self.feed)

    def arc_feed(self, first, second, center_first, center_second, rotation, axis_end, *_):
        axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[self.plane]
        end, center = [0.0] * 3, [0.0] * 3
        end[axes[0]], end[axes[1]], end[axes[2]] = first, second, axis_end
        center[axes[0]], center[axes[1]], center[axes[2]] = center_first, center_second, 0.0
        more = (self.machine(*center), axes[2], rotation)
        self.add("arc", self.machine(*end), self.feed, more)

    def set_feed_rate(self, rate):
        self.feed = 25.4 * rate / 60.0

    def set_plane(self, plane):
        self.plane = plane

    def set_g5x_offset(self, _, x, y, z, *__):
        self.g5x = [25.4 * v for v in (x, y, z)]

    def set_g92_offset(self, x, y, z, *_):
        self.g92 = [25.4 * v for v in (x, y, z)]

    def set_xy_rotation(self, degrees):
        self.angle = math.radians(degrees)

    def tool_offset(self, x, y, z, *_):
        self.tool = [25.4 * v for v in (x, y, z)]

    def next_line(self, state):
        self.line = state.sequence_number

    def get_tool(self, pocket):
        empty = (-1,) + (0.0,) * 9 + (0.0, 0.0, 0.0, 0)
        for index, tool in enumerate(self.tools, 1):
            if pocket in (index, tool[0]):
                return tool
        return empty

    def get_external_angular_units(self):
        return 1.0

    def get_external_length_units(self):
        return 1.0

    def get_axis_mask(self):
        return 7

    def get_block_delete(self):
        return True

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *_: None


def load_tools(table):
    """Gives the interpreter its tool table, which it reads from shared memory."""
    library = ctypes.CDLL("libtooldata.so.0")
    library._Z17tool_mmap_creatorPK13EMC_TOOL_STATi(None, 0)
    library._Z14tool_mmap_userv()
    library._Z13tooldata_initb(False)
    if table:
        library._Z13tooldata_loadPKcPPc(table.encode(), None)


def tools_of(table):
    tools = []
    for line in open(table) if table else ():
        words = line.split(";")[0].split()
        values = {word[0].upper(): float(word[1:]) for word in words}
        if "T" in values:
            offsets = tuple(values.get(axis, 0.0) for axis in "XYZABCUVW")
            tools.append((int(values["T"]),) + offsets + (values.get("D", 0.0), 0.0, 0.0, 0))
    return tools


def ours(moves, program, table):
    command = [moves, program] + ([table] if table else [])
    output = subprocess.run(command, capture_output=True, text=True)
    if output.returncode:
        return None, output.stderr.strip().splitlines()[-1]
    found, at = [], [0.0] * 3
    for line in output.stdout.splitlines():
        words = line.split()
        number, kind, speed = int(words[0]), words[1], float(words[2])
        end = [float(word) for word in words[3:6]]
        more = ()
        if kind == "arc":
            center = [float(word) for word in words[6:9]]
            more = (center, int(words[9]), float(words[10]))
        if kind != "dwell" and (kind == "arc" or math.dist(end, at) > NOWHERE):
            found.append((number, kind, speed, end, more))
        at = end
    return found, None


def compare(program, moves, table):
    name = os.path.join(os.path.basename(os.path.dirname(program)), os.path.basename(program))
    mine, refusal = ours(moves, program, table)
    with tempfile.TemporaryDirectory() as folder:
        variables = os.path.join(folder, "variables")
        open(variables, "w").close()
        canon = Canon(tools_of(table), variables)
        try:
            # The interpreter wants a program to end with a word; the end of the file will do for us.
            whole = os.path.join(folder, "program.ngc")
            with open(program, "rb") as text, open(whole, "wb") as copy:
                copy.write(text.read() + b"\nM2\n")
            result, line = gcode.parse(whole, canon, "G21 G80 G40 G49 G90 G54 G99", "")
        except Exception as error:  # the interpreter reports some refusals so
            result, line = gcode.MIN_ERROR + 1, f"{line_of(canon)}: {error}"
    if result > gcode.MIN_ERROR:
        print(f"{name}: LinuxCNC refuses line {line}: {gcode.strerror(result)}"
              + (f"; we: {refusal}" if refusal else f"; we read {len(mine)} moves"))
        return True
    if refusal:
        print(f"{name}: only we refuse: {refusal}")
        return False
    theirs = canon.moves
    worst = {"end": 0.0, "centre": 0.0, "feedrate": 0.0}
    wrong = []
    for one, other in zip(mine, theirs):
        end = math.dist(one[3], other[3])
        worst["end"] = max(worst["end"], end)
        if one[1] != other[1] or end > CLOSE:
            wrong.append((one, other))
            continue
        if one[2] != other[2] and one[1] != "rapid":
            worst["feedrate"] = max(worst["feedrate"], abs(one[2] - other[2]))
            if abs(one[2] - other[2]) > CLOSE * max(1.0, one[2]):
                wrong.append((one, other))
                continue
        if one[1] == "arc":
            (center, axis, sweep), (there, other_axis, rotation) = one[4], other[4]
            off = math.dist(*[[c for i, c in enumerate(p) if i != axis] for p in (center, there)])
            worst["centre"] = max(worst["centre"], off)
            same = axis == other_axis and (sweep > 0) == (rotation > 0)
            if off > CLOSE or not same:
                wrong.append((one, other))
    counts = len(mine) == len(theirs)
    verdict = "same" if counts and not wrong else "DIFFERENT"
    if not counts and len(mine) * len(theirs) < 1e6:
        # Both make chords of splines, each its own: their points must lie on our path.
        off = max(distance(move[3], mine) for move in theirs)
        last = math.dist(mine[-1][3], theirs[-1][3])
        if off <= SPLINE and last <= CLOSE:
            print(f"{name}: same curve: {len(mine)} and {len(theirs)} moves; theirs leave ours by {off:.1e} mm")
            return True
    numbers = ", ".join(f"{key} {value:.1e}" for key, value in worst.items())
    print(f"{name}: {verdict}: {len(mine)} and {len(theirs)} moves; {numbers}; {len(wrong)} differ")
    for one, other in wrong[:3]:
        print(f"    ours   {one}\n    theirs {other}")
    return verdict == "same"


def distance(point, path):
    """Distance of a point from the straight moves of a path."""
    best, start = math.inf, [0.0] * 3
    for move in path:
        end = move[3]
        along = [b - a for a, b in zip(start, end)]
        square = sum(v * v for v in along)
        share = sum(v * (p - a) for v, p, a in zip(along, point, start)) / square if square else 0.0
        share = min(1.0, max(0.0, share))
        best = min(best, math.dist(point, [a + share * v for a, v in zip(start, along)]))
        start = end
    return best


def line_of(canon):
    return canon.line


def main():
    arguments = sys.argv[1:]
    table = None
    if "--tools" in arguments:
        at = arguments.index("--tools")
        table = arguments[at + 1]
        del arguments[at:at + 2]
    if len(arguments) < 2:
        sys.exit(__doc__)
    load_tools(table)
    sys.stdout.flush()
    failed = False
    for program in arguments[1:]:
        # The interpreter keeps tool and offsets, so each program has one of its own.
        child = os.fork()
        if child == 0:
            same = compare(program, arguments[0], table)
            sys.stdout.flush()
            os._exit(0 if same else 1)
        failed |= os.waitpid(child, 0)[1] != 0
    sys.exit(1 if failed else 0)


main()
