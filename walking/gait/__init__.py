"""The gait: which foot carries, and how the other swings."""
