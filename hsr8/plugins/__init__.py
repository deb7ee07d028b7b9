"""User-defined planners, gazes and walkers: their files, checked inputs and outputs."""
