"""Simulations in Drake, for evaluation."""
