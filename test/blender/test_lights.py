#!/usr/bin/python3
"""Lights of Blender against Cycles: the spread of area lights."""
import run_inside

run_inside.main(__file__)
