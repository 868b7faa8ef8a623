#!/usr/bin/python3
"""Volumes and subsurface scattering of velo in Blender."""
import run_inside

run_inside.main(__file__)
