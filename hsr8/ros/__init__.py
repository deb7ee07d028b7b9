"""Live ROS 2 topics over Zenoh, as the middleware `rmw_zenoh_cpp` expects them, without ROS."""
