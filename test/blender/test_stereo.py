#!/usr/bin/python3
"""Stereo images of velo in Blender: where both eyes see points, and what they see."""
import run_inside

run_inside.main(__file__)
