"""Figures of a paper: draws what ``unshade figure`` gathered from runs."""
