#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How the time and memory of volumetric reconstruction grow, share the machine, and divide into phases.

growth  0.1, 1, 5 and 20 million samples of a mesh at one depth
busy    alone, and beside endless loops that want as many cores as there are threads; Open3D too, where installed
phases  wall and processor time of each phase with one thread and with two, and the speed-up

Every run is a whole process, from reading a binary PLY to writing one. Inputs are made once by fresco_benchmark_inputs.
"""
import argparse
import os
import re
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
TICK = os.sysconf("SC_CLK_TCK")
LOOP = [sys.executable, "-c", "while True: pass"]


def measure(command):
    """Wall time and processor time in s, peak memory in MB of one process."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"reconstruction_scaling.py: failed: {' '.join(command)}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def processor_time(pid):
    """User and system time of all threads of a running process, s."""
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def phase_times(command):
    """[(phase, wall, processor time)]: a phase begins when the program names it on stderr."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    marks = [("read", start, 0.0)]
    for line in process.stderr:
        named = re.match(r"([a-z ]+) \(\d+ %\)", line)
        if named:
            name = "write" if named[1] == "done" else named[1]
            if name != marks[-1][0]:
                marks.append((name, time.monotonic(), processor_time(process.pid)))
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"reconstruction_scaling.py: failed: {' '.join(command)}")
    marks.append(("end", time.monotonic(), usage.ru_utime + usage.ru_stime))
    return [(a[0], b[1] - a[1], b[2] - a[2]) for a, b in zip(marks, marks[1:])]


class Inputs:
    """Paths of the programs, and of samples of the mesh, made where they are missing."""

    def __init__(self, options):
        self.options = options
        os.makedirs(options.cache, exist_ok=True)
        self.output = os.path.join(options.cache, "scaling_output.ply")

    def cloud(self, count):
        stem = os.path.splitext(os.path.basename(self.options.mesh))[0]
        path = os.path.join(self.options.cache, f"{stem}_{count}.ply")
        if not os.path.exists(path):
            program = os.path.join(self.options.bin, "fresco_benchmark_inputs")
            subprocess.run([program, "surface", self.options.mesh, path, "-count", str(count), "-quiet"], check=True)
        return path

    def fresco(self, count, threads):
        return [os.path.join(self.options.bin, "fresco_reconstruct"), self.cloud(count), self.output, "-depth",
                str(self.options.depth), "-threads", str(threads)]

    def open3d(self, count, threads):
        return ["/usr/bin/python3", os.path.join(HERE, "..", "peers", "open3d_poisson.py"), self.cloud(count), self.output,
                "--depth", str(self.options.depth), "--threads", str(threads)]


def growth(inputs):
    print("| points | wall, s | processor time, s | peak memory, MB |\n|---|---|---|---|")
    for count in inputs.options.counts:
        wall, cpu, memory = best(inputs, inputs.fresco(count, inputs.options.threads))
        print(f"| {count:,} | {wall:.2f} | {cpu:.2f} | {memory:.0f} |", flush=True)


def best(inputs, command):
    return min(measure(command) for _ in range(inputs.options.repeat))


def busy(inputs):
    count, threads = inputs.options.counts[0], inputs.options.threads
    print(f"| program | alone, s | beside {threads} loops, s | ratio |\n|---|---|---|---|")
    programs = [("fresco", inputs.fresco(count, threads)), ("Open3D", inputs.open3d(count, threads))]
    if subprocess.run(["/usr/bin/python3", "-c", "import open3d"], stderr=subprocess.DEVNULL).returncode != 0:
        print("Open3D is not installed", file=sys.stderr)
        programs.pop()
    for name, command in programs:
        alone = best(inputs, command)[0]
        loops = [subprocess.Popen(LOOP) for _ in range(threads)]
        try:
            beside = best(inputs, command)[0]
        finally:
            for loop in loops:
                loop.kill()
                loop.wait()
        print(f"| {name} | {alone:.2f} | {beside:.2f} | {beside / alone:.2f} |", flush=True)


def phases(inputs):
    """Least times of all repetitions; runs with one thread and with two take turns."""
    count = inputs.options.counts[0]
    least = {}
    for _ in range(inputs.options.repeat):
        for threads in (1, 2):
            for name, wall, cpu in phase_times(inputs.fresco(count, threads)):
                old = least.get((name, threads), (wall, cpu))
                least[name, threads] = (min(old[0], wall), min(old[1], cpu))
    names = [name for name, threads in least if threads == 1]
    total = sum(least[name, 1][0] for name in names)
    print("| phase | share | 1 thread, s | 2 threads, s | speed-up | processor time 1 / 2, s |")
    print("|---|---|---|---|---|---|")
    for name in names:
        (one, cpu_one), (two, cpu_two) = least[name, 1], least[name, 2]
        print(f"| {name} | {100 * one / total:.0f} % | {one:.3f} | {two:.3f} | {one / two:.2f} | "
              f"{cpu_one:.2f} / {cpu_two:.2f} |")
    two = sum(least[name, 2][0] for name in names)
    print(f"| all | 100 % | {total:.3f} | {two:.3f} | {total / two:.2f} | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("growth", "busy", "phases"))
    parser.add_argument("mesh", help="mesh to be sampled, e.g. igea.ply")
    parser.add_argument("--bin", default=os.path.join(HERE, "..", "..", "build", "bin"), help="folder of the programs")
    parser.add_argument("--cache", default=os.path.join(HERE, "..", "..", "build", "benchmark_cache"),
                        help="folder of the inputs")
    parser.add_argument("--counts", type=int, nargs="+", help="numbers of samples; busy and phases take the first")
    parser.add_argument("--depth", type=int, default=9)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=3, help="runs of each; the fastest counts")
    options = parser.parse_args()
    if not options.counts:
        options.counts = [100_000, 1_000_000, 5_000_000, 20_000_000] if options.what == "growth" else [1_000_000]
    {"growth": growth, "busy": busy, "phases": phases}[options.what](Inputs(options))


if __name__ == "__main__":
    main()
