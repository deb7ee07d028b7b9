"""Field: obstacles, movers, beacons and waypoints, drawn fair and feasible."""
