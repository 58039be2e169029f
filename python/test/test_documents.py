# SPDX-License-Identifier: BSD-3-Clause
"""The example of docs/python.md, the notebook and README's lines run; stubs and signatures agree."""
import ast
import asyncio
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import fresco
import pytest

ROOT = Path(__file__).resolve().parents[2]


def code_of(page: str) -> str:
    return re.search(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf8"), re.S)[1]


@pytest.fixture
def here(room, tmp_path, monkeypatch):
    (tmp_path / "room").symlink_to(room)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_complete_example_runs(here):
    code = code_of("docs/python.md").replace("cell_size=0.02", "cell_size=0.1").replace("reconstruct_texture(mesh, views",
                                                                                      "reconstruct_texture(mesh, views, texel=0.1")
    assert "texel=0.1" in code and "cell_size=0.1" in code and len(code.splitlines()) <= 30
    exec(compile(code, "docs/python.md", "exec"), {})
    assert (here / "out/model.glb").stat().st_size > 10000
    assert len(list((here / "out").glob("*.png"))) == 6


def test_the_lines_of_readme_run(here):
    exec(compile(code_of("README.md").replace("cell_size=0.02", "cell_size=0.2"), "README.md", "exec"), {})
    assert (here / "room.png").exists()


def test_the_notebook_runs(here):
    import nbformat
    from jupyter_client.manager import AsyncKernelManager
    from nbclient import NotebookClient
    book = nbformat.read(ROOT / "examples/python_room.ipynb", 4)
    assert not any(cell.get("outputs") for cell in book.cells)  # kept without outputs
    kernel = AsyncKernelManager(kernel_name="python3")
    kernel.kernel_spec.argv[0] = sys.executable
    asyncio.run(NotebookClient(book, km=kernel, timeout=120).async_execute())
    pictures = [out for cell in book.cells for out in cell.get("outputs", []) if "image/png" in out.get("data", {})]
    assert len(pictures) >= 4


def stub_functions() -> dict[str, ast.FunctionDef]:
    stub = Path(fresco._fresco.__file__).with_name("_fresco.pyi")
    return {node.name: node for node in ast.parse(stub.read_text(encoding="utf8")).body if isinstance(node, ast.FunctionDef)}


def test_stubs_and_signatures_agree():
    functions = {name for name in fresco._fresco.__dict__ if not name.startswith("_")
                 and inspect.isbuiltin(getattr(fresco._fresco, name))}
    stubs = stub_functions()
    assert set(stubs) == functions and {"reconstruct", "snapshot", "build_model"} <= functions
    for name, stub in stubs.items():
        assert ast.unparse(stub.args) != "" and stub.returns is not None
        for argument in stub.args.args + stub.args.kwonlyargs:
            assert argument.annotation is not None
            argument.annotation = None
        shown = inspect.signature(getattr(fresco, name))
        assert ast.unparse(ast.parse(f"def f{shown}: ...").body[0].args) == ast.unparse(stub.args), name
        assert len(getattr(fresco, name).__doc__) > 60


def test_mypy_understands_the_example(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "example.py").write_text(code_of("docs/python.md"))
    environment = {**os.environ, "MYPYPATH": str(Path(fresco.__file__).parents[1])}
    run = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", "example.py"],
                         cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout
    (tmp_path / "wrong.py").write_text("import fresco\nfresco.reconstruct(5)\nfresco.PointSet().colour\n")
    run = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", "wrong.py"],
                         cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert run.stdout.count("error:") == 2, run.stdout
