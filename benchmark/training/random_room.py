#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a closed room with shelves, books, boxes, tables and round things at random places: random_room.py OUT.ply SEED
Metres, floor at z = 0; rooms of odd seeds are turned about the vertical. Things may reach into each other."""
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(f"random_room.py needs numpy (apt-get install python3-numpy): not in {sys.executable}")

BOX_FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                      [0, 6, 4], [1, 5, 7], [1, 7, 3]])
ABOVE = 0.0005  # metres between what stands and what it stands on
AROUND = 64  # faces around a round thing


def yaw(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class Room:
    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        self.vertices, self.faces, self.count = [], [], 0
        self.size = self.random.uniform([5, 4, 2.4], [9, 7, 3.2])
        self.box([0, 0, 0], self.size, inward=True)

    def add(self, vertices, faces):
        self.vertices.append(vertices)
        self.faces.append(np.asarray(faces) + self.count)
        self.count += len(vertices)

    def box(self, low, high, pose=(np.eye(3), np.zeros(3)), inward=False):
        low, high = np.array(low), np.array(high)
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
        self.add(corners @ pose[0].T + pose[1], BOX_FACES[:, ::-1] if inward else BOX_FACES)

    def lathe(self, radii, heights, pose):
        """A profile turned about z, from below to above."""
        angles = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
        vertices = [[r * np.cos(a), r * np.sin(a), z] for r, z in zip(radii, heights) for a in angles]
        faces = []
        for ring in range(len(radii) - 1):
            for i in range(AROUND):
                a, b = ring * AROUND + i, ring * AROUND + (i + 1) % AROUND
                if radii[ring] > 1e-9:
                    faces.append([a, b, b + AROUND])
                if radii[ring + 1] > 1e-9:
                    faces.append([a, b + AROUND, a + AROUND])
        self.add(np.array(vertices) @ pose[0].T + pose[1], faces)

    def rotation(self, any_axis=False):
        upright = yaw(self.random.uniform(0, 2 * np.pi))
        if not any_axis:
            return upright
        w, x, y, z = (q := self.random.normal(size=4)) / np.linalg.norm(q)
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])

    def place(self):
        return np.array([self.random.uniform(0.5, self.size[0] - 0.5), self.random.uniform(0.5, self.size[1] - 0.5), 0])

    def against_wall(self, width):
        wall = int(self.random.integers(4))
        length = self.size[0] if wall < 2 else self.size[1]
        along = self.random.uniform(0.3, max(0.31, length - width - 0.3))
        turned = (np.eye(3), np.diag([-1.0, -1, 1]), np.array([[0, 1.0, 0], [-1, 0, 0], [0, 0, 1]]),
                  np.array([[0, -1.0, 0], [1, 0, 0], [0, 0, 1]]))[wall]
        corner = ([along, 0, 0], [along + width, self.size[1], 0], [0, along + width, 0], [self.size[0], along, 0])[wall]
        return turned, np.array(corner)

    def shelf(self):
        u = self.random.uniform
        thick, depth, width, height = u(0.008, 0.04), u(0.15, 0.6), u(0.5, 2.5), u(0.5, 2.2)
        boards = self.random.integers(2, 9)
        sides = self.random.random() < 0.6
        if self.random.random() < 0.6:
            pose = self.against_wall(width)
        else:
            pose = (self.rotation(), self.place())
        bottom = u(0, 0.8)
        levels = [bottom + height * (k + 0.5) / boards for k in range(boards)]
        for z in levels:
            self.box([0, 0.001, z], [width, depth, z + thick], pose)
        if sides:
            self.box([-thick, 0.001, 0], [0, depth, bottom + height], pose)
            self.box([width, 0.001, 0], [width + thick, depth, bottom + height], pose)
            if self.random.random() < 0.6:
                for z in levels:
                    self.books(pose, (width, depth, z + thick), 0.9 * height / boards - thick)

    def books(self, pose, board, most):
        u, (width, depth, z), x = self.random.uniform, board, 0.02
        while x < width - 0.06 and self.random.random() < 0.93:
            thick = u(0.008, 0.05)
            back = depth - u(0.1, depth if depth > 0.12 else 0.12) * 0.8 - 0.02
            front = depth - u(0, 0.03)
            self.box([x, back, z], [x + thick * 0.97, front, z + min(u(0.12, 0.3), most)], pose)
            x += thick + (self.random.random() < 0.1) * 0.05

    def crate(self):
        size = self.random.uniform(0.03, 0.6, 3) * self.random.choice([0.3, 1, 1.5])
        tilted = self.random.random() < 0.25
        pose = (self.rotation(tilted), self.place() + [0, 0, self.random.uniform(0.3, 1.5) if tilted else 0])
        self.box([-size[0] / 2, -size[1] / 2, ABOVE], [size[0] / 2, size[1] / 2, size[2]], pose)

    def table(self):
        size = self.random.uniform([0.3, 0.3, 0.35], [1.6, 0.9, 0.9])
        thick, leg = self.random.uniform(0.015, 0.05), self.random.uniform(0.02, 0.08)
        pose = (self.rotation(), self.place())
        self.box([-size[0] / 2, -size[1] / 2, size[2]], [size[0] / 2, size[1] / 2, size[2] + thick], pose)
        for a in (-1, 1):
            for b in (-1, 1):
                x, y = a * (size[0] / 2 - leg), b * (size[1] / 2 - leg)
                self.box([x - leg / 2, y - leg / 2, 0], [x + leg / 2, y + leg / 2, size[2] - ABOVE], pose)

    def round_thing(self):
        radius = self.random.uniform(0.03, 0.5)
        pose = (self.rotation(self.random.random() < 0.3), self.place() + [0, 0, self.random.uniform(0.2, 1.5)])
        kind, height = self.random.integers(4), self.random.uniform(0.1, 1.2)
        if kind == 0:  # ball
            t = np.linspace(-np.pi / 2, np.pi / 2, 33)
            self.lathe(np.maximum(radius * np.cos(t), 0) * (np.abs(t) < 1.57), radius * np.sin(t), pose)
        elif kind == 1:  # cylinder
            self.lathe([0, radius, radius, 0], [0, 0, height, height], pose)
        elif kind == 2:  # cone
            self.lathe([0, radius, 0], [0, 0, height], pose)
        else:  # vase
            t = np.linspace(0, 1, 17)
            self.lathe(np.r_[0, radius * (0.5 + 0.4 * np.sin(5 * t)), 0], np.r_[0, height * t, height], pose)

    def furnish(self):
        for add, least, most in ((self.shelf, 3, 7), (self.crate, 8, 25), (self.table, 2, 6), (self.round_thing, 4, 12)):
            for _ in range(self.random.integers(least, most)):
                add()

    def write(self, path, turned):
        vertices, faces = np.concatenate(self.vertices), np.concatenate(self.faces)
        if turned:
            vertices = vertices @ self.rotation().T
        with open(path, "w") as file:
            file.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
                       f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\n"
                       "end_header\n")
            np.savetxt(file, vertices, fmt="%.5f")
            np.savetxt(file, np.c_[np.full(len(faces), 3), faces], fmt="%d")


def main():
    if len(sys.argv) != 3 or not sys.argv[2].isdigit():
        sys.exit(__doc__)
    room = Room(int(sys.argv[2]))
    room.furnish()
    room.write(sys.argv[1], int(sys.argv[2]) % 2 == 1)


if __name__ == "__main__":
    main()
