"""Cameras: pinholes, and lenses that distort."""
