"""What README and docs/python.md show does what they say."""

import re

import pytest
from conftest import ROOT


def examples(name: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / name).read_text(), re.M | re.S)


@pytest.mark.parametrize("name", ["README.md", "docs/python.md"])
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = examples(name)
    assert found
    names: dict = {"__name__": "example"}
    for number, code in enumerate(found):
        exec(compile(code, f"{name}, example {number}", "exec"), names)


def test_every_public_name_is_documented():
    import pentimento

    page = (ROOT / "docs" / "python.md").read_text()
    for name in pentimento.__all__:
        assert f"`{name}" in page or name == "__version__", name
        assert getattr(pentimento, name).__doc__ or name == "__version__", name
