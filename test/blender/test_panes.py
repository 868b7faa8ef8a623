#!/usr/bin/python3
"""Open surfaces of glass in Blender are thin panes; others are solids."""
import run_inside

run_inside.main(__file__)
