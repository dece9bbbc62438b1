"""Simulations in Drake."""
