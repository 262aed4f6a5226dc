"""Runs the gallery: every script must hold what it says, and its page must be as committed.

``run.py --write`` writes pages and pictures anew. A script begins with a title and prose, ends with a figure of that
name, and asserts what its prose claims.
"""

from __future__ import annotations

import ast
import runpy
import sys
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

HERE = Path(__file__).resolve().parent
PAGES = HERE.parents[2] / "docs" / "python"


def scripts() -> list[Path]:
    return sorted(path for path in HERE.glob("*.py") if path.name != "run.py")


def page(path: Path) -> str:
    """The page of a script: its prose, its picture, its code."""
    text = path.read_text()
    module = ast.parse(text)
    prose = ast.get_docstring(module) or ""
    title, _, rest = prose.partition("\n")
    code = "\n".join(text.splitlines()[module.body[0].end_lineno :]).strip()
    return (
        f"# {title.rstrip('.')}\n\n{rest.strip()}\n\n![{title.rstrip('.')}]({path.stem}.png)\n\n"
        f"```python\n{code}\n```\n"
    )


def main() -> None:
    import matplotlib.pyplot as plt

    write = "--write" in sys.argv
    only = [word for word in sys.argv[1:] if not word.startswith("--")]
    if write:
        PAGES.mkdir(exist_ok=True)
    for path in scripts():
        if only and path.stem not in only:
            continue
        began = time.perf_counter()
        figure = runpy.run_path(str(path))["figure"]
        if write:
            picture = PAGES / f"{path.stem}.png"
            figure.savefig(picture, dpi=72, pil_kwargs={"optimize": True}, metadata={"Software": None})
            (PAGES / f"{path.stem}.md").write_text(page(path))
        else:
            committed = PAGES / f"{path.stem}.md"
            assert committed.exists() and committed.read_text() == page(path), (
                f"{committed.name} is not the page of {path.name}: .ci/python pictures writes it"
            )
            assert (PAGES / f"{path.stem}.png").exists(), f"{path.stem}.png is missing"
        plt.close("all")
        print(f"   gallery, {path.stem}: {time.perf_counter() - began:.1f} s", flush=True)


if __name__ == "__main__":
    main()
