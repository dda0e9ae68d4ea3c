"""Soft bodies: the displacement of their surface under a pressure."""
