# SPDX-License-Identifier: BSD-3-Clause
"""What pip calls (PEP 517): CMake builds the module with all of fresco inside, and a wheel is packed. Nothing is downloaded."""
from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from typing import Any, Optional

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build-pip"  # kept: the next build is short


def version() -> str:
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf8")
    return re.search(r"project\(fresco VERSION ([\d.]+)", text)[1]


def metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: fresco\nVersion: {version()}\nLicense: BSD-3-Clause\nRequires-Python: >=3.9\n"
            "Requires-Dist: numpy\nSummary: Raw indoor scans to photo-realistic textured models\n")


def build_package() -> Path:
    """Folder that holds the package `fresco`."""
    generator = [] if (BUILD / "CMakeCache.txt").exists() else ["-G", "Ninja"]
    off = [f"-DFRESCO_BUILD_{part}=OFF" for part in ("TOOLS", "TESTS", "BENCHMARKS")]
    subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_SHARED_LIBS=OFF",
                    "-DCMAKE_INSTALL_LIBDIR=lib", f"-DFRESCO_PYTHON={sys.executable}", *off], check=True)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
    subprocess.run(["cmake", "--build", BUILD, "--target", "fresco_python", "--parallel", jobs], check=True)
    subprocess.run(["cmake", "--install", BUILD, "--component", "python", "--prefix", BUILD / "wheel"], check=True)
    return BUILD / "wheel/lib/python3/dist-packages"


def build_wheel(wheel_directory: str, config_settings: Optional[dict[str, Any]] = None,
                metadata_directory: Optional[str] = None) -> str:
    package = build_package()
    info = f"fresco-{version()}.dist-info"
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    wheel = f"fresco-{version()}-{tag}.whl"
    files = {str(path.relative_to(package)): path.read_bytes() for path in sorted(package.glob("fresco/*")) if path.is_file()}
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: fresco\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = ""
    with zipfile.ZipFile(Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
            record += f"{name},sha256={digest},{len(content)}\n"
            archive.writestr(name, content)
        archive.writestr(f"{info}/RECORD", record + f"{info}/RECORD,,\n")
    return wheel
