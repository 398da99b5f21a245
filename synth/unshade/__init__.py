"""Measures how well a face's reflectance can be recovered from photographs."""
