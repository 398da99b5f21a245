"""Blender's Cycles as a second renderer, in a process and a Python of its own.

`interpreter` finds it, `description` writes what to render as plain files, `blender_child` runs inside Blender and
imports nothing of ours, `relight` renders the pictures that Mitsuba's relighting renders.
"""
