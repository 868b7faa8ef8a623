#!/usr/bin/python3
"""Attributes of meshes in velo's materials in Blender: of points, corners and faces; several colours; missing ones."""
import run_inside

run_inside.main(__file__)
