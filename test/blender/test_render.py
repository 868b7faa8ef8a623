#!/usr/bin/python3
"""The first renders of velo in Blender: light, materials, passes against Cycles; bad input."""
import run_inside

run_inside.main(__file__)
