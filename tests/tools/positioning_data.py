# SPDX-License-Identifier: MIT
"""The real recordings as plain lists for positioning_table.py: IMU rows, GNSS rows, reference positions.

A drive is a dict: imu = [(stamp_ns, ax, ay, az, gx, gy, gz[, qx, qy, qz, qw])], the IMU's own orientation where the recording
has one, gnss = [(stamp_ns, lat, lon, alt, sd_e, sd_n, sd_u)],
reference = [(stamp_ns, lat, lon, alt)]. Axes forward-left-up, SI units."""
import ast
import calendar
import glob
import math
import re
import struct
import time
from pathlib import Path

G = 9.80665


def ecef(lat_deg, lon_deg, alt):
    """WGS84."""
    a, e2 = 6378137.0, 6.69437999014e-3
    lat, lon = math.radians(lat_deg), math.radians(lon_deg)
    n = a / math.sqrt(1.0 - e2 * math.sin(lat) ** 2)
    return ((n + alt) * math.cos(lat) * math.cos(lon), (n + alt) * math.cos(lat) * math.sin(lon),
            (n * (1.0 - e2) + alt) * math.sin(lat))


def geodetic(x, y, z):
    a, e2 = 6378137.0, 6.69437999014e-3
    lon, p = math.atan2(y, x), math.hypot(x, y)
    lat, alt = math.atan2(z, p * (1.0 - e2)), 0.0
    for _ in range(8):
        n = a / math.sqrt(1.0 - e2 * math.sin(lat) ** 2)
        alt = p / math.cos(lat) - n
        lat = math.atan2(z, p * (1.0 - e2 * n / (n + alt)))
    return math.degrees(lat), math.degrees(lon), alt


class Enu:
    def __init__(self, lat, lon, alt):
        self.origin = ecef(lat, lon, alt)
        self.lat, self.lon = math.radians(lat), math.radians(lon)

    def of(self, lat, lon, alt):
        d = [b - a for a, b in zip(self.origin, ecef(lat, lon, alt))]
        sl, cl, so, co = math.sin(self.lat), math.cos(self.lat), math.sin(self.lon), math.cos(self.lon)
        return (-so * d[0] + co * d[1], -sl * co * d[0] - sl * so * d[1] + cl * d[2],
                cl * co * d[0] + cl * so * d[1] + sl * d[2])

    def inverse(self, e, n, u):
        sl, cl, so, co = math.sin(self.lat), math.cos(self.lat), math.sin(self.lon), math.cos(self.lon)
        x, y, z = (-so * e - sl * co * n + cl * co * u, co * e - sl * so * n + cl * so * u, cl * n + sl * u)
        return geodetic(*(a + b for a, b in zip(self.origin, (x, y, z))))


def npy(path):
    """Rows of a little-endian float64 array of one or two dimensions."""
    data = Path(path).read_bytes()
    size = struct.unpack("<H", data[8:10])[0]
    head = ast.literal_eval(data[10:10 + size].decode())
    shape, kind = head["shape"], {"<f8": "d", "<f4": "f", "<i8": "q"}[head["descr"]]
    count = math.prod(shape)
    values = struct.unpack("<%d%s" % (count, kind), data[10 + size:10 + size + count * struct.calcsize(kind)])
    if len(shape) == 1:
        return [(v,) for v in values]
    if head["fortran_order"]:
        return [tuple(values[j * shape[0] + i] for j in range(shape[1])) for i in range(shape[0])]
    return [values[i * shape[1]:(i + 1) * shape[1]] for i in range(shape[0])]


def quaternion(roll, pitch, yaw):
    cr, sr, cp, sp, cy, sy = (f(a / 2) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def walk(root):
    folder = root / "gnss_imu_rtk_walk/walk_0827"
    gnss, reference = [], []
    for line in (folder / "gnss_1730_sf.pos").read_text().splitlines():
        f = line.split()
        if line.startswith("%") or len(f) < 10:
            continue
        day, clock = f[0].split("/"), f[1].split(":")
        whole = calendar.timegm((int(day[0]), int(day[1]), int(day[2]), int(clock[0]), int(clock[1]), 0))
        stamp = whole * 10**9 + round(float(clock[2]) * 1e3) * 10**6
        lat, lon, alt = (float(v) for v in f[2:5])
        gnss.append((stamp, lat, lon, alt, float(f[8]), float(f[7]), float(f[9])))
        if float(f[5]) == 1.0:
            reference.append((stamp, lat, lon, alt))
    imu = []
    for line in (folder / "imu_1730_gpst.csv").read_text().splitlines()[1:]:
        v = [float(x) for x in line.split(",")]
        # z is up: the mean force is +1.01 g there, and the rate about it follows the course (correlation +0.85 over
        # windows of 1 s). x is left: the centripetal acceleration v * course rate appears there (+0.82; on y 0.23).
        # So forward is x cross z = -y, where the change of speed appears (-0.17 on y: a swinging pole; on x -0.02).
        v[1:7] = -v[2], v[1], v[3], -v[5], v[4], v[6]
        imu.append((round(v[0] * 1e4) * 10**5, *(G * a for a in v[1:4]), *(math.radians(w) for w in v[4:7])))
    return {"imu": imu, "gnss": gnss, "reference": reference}


def comma(root):
    folder = glob.glob(str(root / "comma2k19_seg/Example_1/*/40"))[0]
    log = folder + "/processed_log/"
    force, turn = npy(log + "IMU/accelerometer/value"), npy(log + "IMU/gyro/value")
    t_force, t_turn = npy(log + "IMU/accelerometer/t"), npy(log + "IMU/gyro/t")
    imu, j = [], 0
    for (t,), f in zip(t_force, force):
        while j + 1 < len(t_turn) and abs(t_turn[j + 1][0] - t) <= abs(t_turn[j][0] - t):
            j += 1
        # The device's x points forward, y right, z down: reversed y and z are left and up.
        imu.append((round(t * 1e9), f[0], -f[1], -f[2], turn[j][0], -turn[j][1], -turn[j][2]))
    fixes = zip(npy(log + "GNSS/live_gnss_ublox/t"), npy(log + "GNSS/live_gnss_ublox/value"))
    gnss = [(round(t[0] * 1e9), v[0], v[1], v[4], 1.5, 1.5, 3.0) for t, v in fixes]
    reference = [(round(t[0] * 1e9), *geodetic(*p)) for t, p in
                 zip(npy(folder + "/global_pose/frame_times"), npy(folder + "/global_pose/frame_positions"))]
    return {"imu": imu, "gnss": gnss, "reference": reference}


def kitti_rows(folder):
    """Stamps and values of an oxts stream: of a raw drive (a file a row), or of the tracking benchmark (one file)."""
    stamps, folder = [], Path(folder)
    times = next(path for pattern in ("timestamps.txt", "*_times.txt") for path in folder.rglob(pattern))
    for line in times.read_text().splitlines():
        m = re.match(r"(\S+ \S+)\.(\d+)", line)
        if m:
            whole = calendar.timegm(time.strptime(m.group(1), "%Y-%m-%d %H:%M:%S"))
            stamps.append(whole * 10**9 + int(m.group(2).ljust(9, "0")[:9]))
    files = sorted(folder.rglob("data/*.txt")) or sorted(p for p in folder.glob("*.txt") if p.stem.isdigit())
    rows = [line for file in files for line in file.read_text().splitlines() if line.strip()]
    return zip(stamps, ([float(x) for x in row.split()] for row in rows))


def kitti(folder, random, sigma_m=2.0, rate_hz=1.0, heading_deg=None):
    """The oxts stream degraded on purpose: fixes of `rate_hz` with white noise, a heading with noise of `heading_deg` or none.
    The orientation is its roll and pitch; its yaw is the reference's and stays out (0 stands for it)."""
    imu, gnss, reference, enu, due = [], [], [], None, None
    for stamp, v in kitti_rows(folder):
        if imu and stamp <= imu[-1][0]:
            continue
        imu.append((stamp, *v[11:14], *v[17:20], *quaternion(v[3], v[4], 0.0)))
        reference.append((stamp, *v[0:3]))
        enu = enu or Enu(*v[0:3])
        due = stamp if due is None else due
        if stamp >= due - 10**7:
            p = [a + random.gauss(0.0, sigma_m) for a in enu.of(*v[0:3])]
            heading = ()
            if heading_deg is not None:
                heading = ((90.0 - math.degrees(v[5]) + random.gauss(0.0, heading_deg)) % 360.0, heading_deg)
            gnss.append((stamp, *enu.inverse(*p), sigma_m, sigma_m, sigma_m, *heading))
            due += round(1e9 / rate_hz)
    return {"imu": imu, "gnss": gnss, "reference": reference}


def husky(root):
    """Husky robot, consumer GNSS. How the IMU is mounted is not documented: y is up (gravity), -z forward and -x left (they agree
    with the acceleration and the centripetal acceleration of the wheels' odometry). The heading is that of its compass; the
    angle from its x axis to the course (mount, declination) is taken from this very recording."""
    import rosbag
    compass_to_course_deg, compass_sigma_deg = 144.0, 10.0
    imu, gnss, yaw_deg = [], [], None
    with rosbag.Bag(str(root / "ros1_bags/robot_localization_test1.bag")) as bag:
        for _, message, _ in bag.read_messages():
            kind, stamp = getattr(message, "_type", ""), message.header.stamp.to_nsec()
            if kind == "sensor_msgs/Imu":
                a, w, q = message.linear_acceleration, message.angular_velocity, message.orientation
                # The columns of the turn are the axes forward, left, up as the IMU has them: -z, -x, y.
                own = product((q.x, q.y, q.z, q.w), (-0.5, 0.5, 0.5, 0.5))
                imu.append((stamp, -a.z, -a.x, a.y, -w.z, -w.x, w.y, *own))
                yaw_deg = math.degrees(math.atan2(2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.y**2 + q.z**2))) - compass_to_course_deg
            elif kind == "sensor_msgs/NavSatFix" and message.status.status >= 0 and yaw_deg is not None:
                c = message.position_covariance
                gnss.append((stamp, message.latitude, message.longitude, message.altitude,
                             math.sqrt(c[0]), math.sqrt(c[4]), math.sqrt(c[8]), (90.0 - yaw_deg) % 360.0, compass_sigma_deg))
    return {"imu": sorted(set(imu)), "gnss": sorted(set(gnss)), "reference": [(g[0], *g[1:4]) for g in sorted(set(gnss))]}
