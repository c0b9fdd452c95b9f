"""Waves that stiffen: what a dent stores by stretching the layers it bends."""
