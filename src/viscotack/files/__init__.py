"""Files: atomic writes, tables of quantities with units, text, TOML, archives and data frames."""
