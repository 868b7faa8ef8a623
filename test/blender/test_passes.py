#!/usr/bin/python3
"""Passes of velo in Blender, and motion blur of vertices: as Cycles has them."""
import run_inside

run_inside.main(__file__)
