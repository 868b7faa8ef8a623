#!/usr/bin/python3
"""Cameras of velo in Blender: points where Blender's own functions and Cycles see them."""
import run_inside

run_inside.main(__file__)
