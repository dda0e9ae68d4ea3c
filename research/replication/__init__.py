"""What others published about detachment, done again with the public names of viscotack.

``python -m research.replication --list``, from the root of a checkout, says what there is.
``table`` reads rows of detachments, published ones and those of a campaign; each room holds one
publication's claims put to the test. Nothing here is installed with the package.
"""
