"""Loads the reader in scripts and in ParaView's Python Shell, by runpy.run_path() of this file."""

import pathlib
import runpy

from paraview import simple

_folder = pathlib.Path(__file__).resolve().parent
runpy.run_path(str(_folder / "usercustomize.py"))
simple.LoadPlugin(str(_folder / "PentimentoReader.py"), ns=globals())
