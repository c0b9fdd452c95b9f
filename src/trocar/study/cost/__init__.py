"""What steps and studies cost on this machine."""
