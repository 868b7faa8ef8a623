#!/usr/bin/python3
"""Nodes of lamps in Blender: lamp files, textures over directions and places, falloff; files that are none."""
import run_inside

run_inside.main(__file__)
