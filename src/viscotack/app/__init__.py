"""The commands of the command line: words in, words and pictures out. No physics."""
