"""Mitsuba as the ground truth: lights, cameras, skin material, captures and relighting."""
