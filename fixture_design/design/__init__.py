"""Design: where the locators and clamps go."""
