"""What moves the instruments: scripted hands, recordings, the page's hands; haptic hardware takes the same seam."""
