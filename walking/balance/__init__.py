"""Balance: what the ankles, the pattern and the next foothold do against a fall."""
