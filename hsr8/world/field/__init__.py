"""The field: what stands and moves on it, drawn so that it is fair and can be crossed."""
