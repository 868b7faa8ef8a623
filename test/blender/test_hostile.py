#!/usr/bin/python3
"""Hostile scenes of velo in Blender: numbers that are none, huge ones, cycles, what is missing: one line, no fault, finite images."""
import run_inside

run_inside.main(__file__)
