"""A study's folder: files, written whole or not at all."""
