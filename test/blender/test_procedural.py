#!/usr/bin/python3
"""Procedural textures and other nodes that velo in Blender bakes: the same pixels as Cycles'."""
import run_inside

run_inside.main(__file__)
