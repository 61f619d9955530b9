# SPDX-License-Identifier: MIT
"""A drive (positioning_data.py) through atlas_localize, and its errors against the reference."""
import bisect
import json
import math
import subprocess
import tempfile
from pathlib import Path

import positioning_data

IMU_HEAD = "stamp_ns,ax,ay,az,gx,gy,gz"
GNSS_HEAD = "stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u"


def write(path, head, rows):
    path.write_text(head + "\n" + "".join(",".join(v if isinstance(v, str) else repr(v) for v in row) + "\n" for row in rows))


def stamp_of(text):
    whole, part = text.split(".")
    return int(whole) * 10**9 + int(part)


def tum_lines(path):
    """Stamps, and the lines they stand in: few of them are read."""
    lines = path.read_text().splitlines()
    return [stamp_of(line[:line.index(" ")]) for line in lines], lines


def pose_of(line):
    return tuple(float(v) for v in line.split()[1:8])


def matrix_of(q):
    x, y, z, w = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def roll_pitch_yaw(q):
    R = matrix_of(q)
    return math.atan2(R[2][1], R[2][2]), -math.asin(max(-1.0, min(1.0, R[2][0]))), math.atan2(R[1][0], R[0][0])


def turned_back(R, v):
    """R' v."""
    return [sum(R[k][i] * v[k] for k in range(3)) for i in range(3)]


def rotation_between(q_from, q_to):
    """Small rotation about the map's axes that turns q_from into q_to."""
    A, B = matrix_of(q_from), matrix_of(q_to)
    C = [[sum(B[i][k] * A[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    return [0.5 * (C[2][1] - C[1][2]), 0.5 * (C[0][2] - C[2][0]), 0.5 * (C[1][0] - C[0][1])]


def nees(e, c):
    """e' C^-1 e; c = upper triangle xx xy xz yy yz zz."""
    xx, xy, xz, yy, yz, zz = c
    adjugate = ((yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy),
                (xz * yz - xy * zz, xx * zz - xz * xz, xy * xz - xx * yz),
                (xy * yz - xz * yy, xy * xz - xx * yz, xx * yy - xy * xy))
    det = xx * adjugate[0][0] + xy * adjugate[1][0] + xz * adjugate[2][0]
    return sum(e[i] * adjugate[i][j] * e[j] for i in range(3) for j in range(3)) / det


class Prepared:
    """The folder of a drive with its IMU files, written once: imu.csv, and with own_only_for, the one filter that may see the
    IMU's own orientation, plain.csv for the others."""

    def __init__(self, drive, own_only_for=None):
        self.drive = drive
        self.keep = tempfile.TemporaryDirectory()
        self.folder = Path(self.keep.name)
        self.own_only_for = own_only_for
        write(self.folder / "imu.csv", IMU_HEAD + (",qx,qy,qz,qw" if len(drive["imu"][0]) > 7 else ""), drive["imu"])
        if own_only_for:
            write(self.folder / "plain.csv", IMU_HEAD, [row[:7] for row in drive["imu"]])

    def imu_for(self, name):
        return self.folder / ("imu.csv" if self.own_only_for in (None, name) else "plain.csv")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.keep.cleanup()


class Run:
    """One run of one filter. mask = (from, to) s without any GNSS, blind = (from, to) s without its heading."""

    def __init__(self, program, prepared, name, mask=None, blind=None, lever=(0.0, 0.0, 0.0), covariances=False):
        self.drive, self.tracks, self.covariances = prepared.drive, {}, {}
        self.begin = self.drive["imu"][0][0]
        gnss = []
        for row in self.drive["gnss"]:
            t = (row[0] - self.begin) / 1e9
            if mask and mask[0] < t <= mask[1]:
                continue
            gnss.append((*row[:7], "", "") if blind and blind[0] < t <= blind[1] else row)
        with tempfile.TemporaryDirectory(dir=prepared.folder) as folder:
            out = Path(folder)
            write(out / "gnss.csv", GNSS_HEAD + (",heading_deg,sd_heading" if len(gnss[0]) > 7 else ""), gnss)
            command = [program, "--imu", prepared.imu_for(name), "--gnss", out / "gnss.csv", "--out", out,
                       "--lever-arm", ",".join(map(str, lever)), "--filter", name] + ["--covariances"] * covariances
            self.ok = subprocess.run(command, capture_output=True, check=False).returncode == 0
            if not self.ok:
                return
            anchor = json.loads((out / "anchor.json").read_text())
            self.enu = positioning_data.Enu(anchor["latitude"], anchor["longitude"], anchor["altitude"])
            files = {name: "trajectory"}
            if name == "eskf":
                files["eskf + smoother"] = "smoothed"
            for track, file in files.items():
                self.tracks[track] = tum_lines(out / (file + ".tum"))
                if covariances:
                    self.covariances[track] = (out / (file + "_covariance.csv")).read_text().splitlines()[1:]

    def errors(self, name, from_s=-math.inf, to_s=math.inf):
        """One dict a reference row: t (s), horizontal (m); of synthetic drives also roll, pitch, yaw (deg) and, with
        covariances, the NEES of position, velocity and attitude."""
        stamps, lines = self.tracks[name]
        result = []
        for row in self.drive["reference"]:
            t = (row[0] - self.begin) / 1e9
            i = bisect.bisect_left(stamps, row[0])
            if not from_s < t <= to_s or i == 0 or i >= len(stamps):
                continue
            pose = pose_of(lines[i])
            truth = self.enu.of(*row[1:4])
            if stamps[i] == row[0]:
                p = [truth[j] - pose[j] for j in range(3)]
            else:
                k, before = (row[0] - stamps[i - 1]) / (stamps[i] - stamps[i - 1]), pose_of(lines[i - 1])
                p = [truth[j] - (1 - k) * before[j] - k * pose[j] for j in range(3)]
            error = {"t": t, "horizontal": math.hypot(p[0], p[1])}
            if len(row) > 4:
                for axis, a, b in zip(("roll", "pitch", "yaw"), roll_pitch_yaw(pose[3:7]), roll_pitch_yaw(row[4])):
                    error[axis] = math.degrees(math.remainder(a - b, 2 * math.pi))
            if name in self.covariances:
                f = [float(v) for v in self.covariances[name][i].split(",")[1:]]
                v_imu = turned_back(matrix_of(row[4]), row[5])
                error["position"] = nees(p, f[3:9])
                error["velocity"] = nees([a - b for a, b in zip(v_imu, f[0:3])], f[9:15])
                error["attitude"] = nees(rotation_between(pose[3:7], row[4]), f[15:21])
            result.append(error)
        return result
