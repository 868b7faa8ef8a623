#!/usr/bin/python3
"""Shaders of velo in Blender as artists wire them: emission, normal maps, muted nodes, random numbers."""
import run_inside

run_inside.main(__file__)
