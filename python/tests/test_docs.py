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


def undocumented(kind: type) -> list[str]:
    """What of a class anybody may call and nobody is told of."""
    own = {name: value for name, value in vars(kind).items() if not name.startswith("_")}
    told = {
        name: getattr(value, "__func__", getattr(value, "fget", None) or value)
        for name, value in own.items()
        if callable(value) or isinstance(value, (property, classmethod, staticmethod))
    }
    return [f"{kind.__name__}.{name}" for name, value in told.items() if not value.__doc__]


def test_every_member_of_a_public_class_says_what_it_is():
    import pentimento

    kinds = [value for value in vars(pentimento).values() if isinstance(value, type)]
    assert len(kinds) > 15
    inherited = {base for kind in kinds for base in kind.__mro__ if "pentimento" in base.__module__}
    assert [name for kind in sorted(inherited, key=str) for name in undocumented(kind)] == []


def test_every_public_name_is_documented():
    import pentimento

    page = (ROOT / "docs" / "python.md").read_text()
    for name in pentimento.__all__:
        assert f"`{name}" in page or name == "__version__", name
        assert getattr(pentimento, name).__doc__ or name == "__version__", name
