"""Command line, HTTP API and web page. No physics."""
