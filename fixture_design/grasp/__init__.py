"""Grasps: the same theory with a hand. A grasp is a fixture with fingers."""
